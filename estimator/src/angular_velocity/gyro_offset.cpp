// SPDX-License-Identifier: BSD-3-Clause
#include "gyro_offset.hpp"

namespace tumble {

GyroOffset::GyroOffset() : rest_detector_({.rate_max_rad_s = kOffsetMax_rad_s, .rest_s = 0.5}) {}

std::optional<Eigen::Vector3d> GyroOffset::detect_initial_offset(const ImuSample& sample, State& state) const {
  if (state.offset_decided) return std::nullopt;
  if (!state.first_ns) state.first_ns = sample.time_ns;
  const bool rests = rest_detector_.detect_stationary(sample, state.stationary_state);
  state.offset_decided =
      rests || check_stamp_order(sample.time_ns, *state.first_ns, kInitialRestLatestEnd_s).error_code == ErrorCode::gap;
  if (!rests) return std::nullopt;
  const Eigen::Vector3d offset = state.stationary_state.mean_rate_rad_s();
  if (offset.cwiseAbs().maxCoeff() <= kOffsetMin_rad_s) return std::nullopt;
  return offset;
}

Eigen::Vector3d GyroOffset::find(std::span<const ImuSample> samples) const {
  State state;
  for (const ImuSample& sample : samples) {
    if (const std::optional<Eigen::Vector3d> offset = detect_initial_offset(sample, state)) return *offset;
    if (state.offset_decided) break;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace tumble
