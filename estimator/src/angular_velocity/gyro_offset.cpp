// SPDX-License-Identifier: BSD-3-Clause
#include "gyro_offset.hpp"

namespace tumble {

GyroOffset::GyroOffset() : rest_detector_({.rate_max_rad_s = kOffsetMax_rad_s, .rest_s = 0.5}) {}

std::optional<Eigen::Vector3d> GyroOffset::observe(const ImuSample& sample, State& state) const {
  if (state.decided) return std::nullopt;
  if (!state.first_ns) state.first_ns = sample.time_ns;
  const bool rests = rest_detector_.observe(sample, state.rest);
  state.decided =
      rests || check_stamp_order(sample.time_ns, *state.first_ns, kRestEndMax_s).error_code == ErrorCode::gap;
  if (!rests) return std::nullopt;
  const Eigen::Vector3d offset = state.rest.mean_rate_rad_s();
  if (offset.cwiseAbs().maxCoeff() <= kOffsetMin_rad_s) return std::nullopt;
  return offset;
}

Eigen::Vector3d GyroOffset::find(std::span<const ImuSample> samples) const {
  State state;
  for (const ImuSample& sample : samples) {
    if (const std::optional<Eigen::Vector3d> offset = observe(sample, state)) return *offset;
    if (state.decided) break;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace tumble
