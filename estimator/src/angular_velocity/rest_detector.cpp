// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rest_detector.hpp"

#include <algorithm>

#include "tumble/common/status.hpp"

namespace tumble {

RestDetector::RestDetector(const Params& params) : params_(params) {
  require_valid_fields(params);
  const CallerSettings& settings = params.caller_settings;
  require_in_interval("force_min_m_s2", settings.force_min_m_s2, 0.0, 100.0);
  require_in_interval("force_max_m_s2", settings.force_max_m_s2, 0.0, 1e6);
  require_in_interval("reading_s", settings.reading_s, 0.0, 1.0);
  require_in_interval("memory_s", settings.memory_s, 1e-3, 1e6);
}

Eigen::Vector3d RestDetector::State::mean_rate_rad_s() const {
  return weight > 0.0 ? Eigen::Vector3d((1.0 / weight) * rate_sum_rad_s) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d RestDetector::State::mean_force_m_s2() const {
  return weight > 0.0 ? Eigen::Vector3d((1.0 / weight) * force_sum_m_s2) : Eigen::Vector3d::Zero();
}

bool RestDetector::detect_stationary(const ImuSample& sample, State& state, const Eigen::Vector3d& bias_rad_s) const {
  if (state.pending_samples++ == 0) {
    state.pending_rate_rad_s.setZero();
    state.pending_force_m_s2.setZero();
    state.pending_first_ns = sample.time_ns;
  }
  state.pending_rate_rad_s += sample.angular_velocity_rad_s;
  state.pending_force_m_s2 += sample.specific_force_m_s2;
  const double half_s = 0.5 * seconds(sample.time_ns - state.last_ns);
  const bool whole =
      !state.started || seconds(sample.time_ns - state.last_reading_ns) >= params_.caller_settings.reading_s - half_s;
  state.started = true;
  state.last_ns = sample.time_ns;
  if (!whole) return state.is_stationary;
  const double share = 1.0 / static_cast<double>(state.pending_samples);
  state.pending_samples = 0;
  state.last_reading_ns = sample.time_ns;
  return detect_stationary_from_mean(share * state.pending_rate_rad_s, share * state.pending_force_m_s2,
                                     state.pending_first_ns, sample.time_ns, bias_rad_s, state);
}

/// See attitude.md (A15).
bool RestDetector::detect_stationary_from_mean(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2,
                                               TimeNs from_ns, TimeNs to_ns, const Eigen::Vector3d& bias_rad_s,
                                               State& state) const {
  const double step_s = seconds(to_ns - state.last_averaged_reading_ns);
  state.last_averaged_reading_ns = to_ns;
  state.is_stationary = false;
  if (state.weight > 0.0) {
    const double share = 1.0 / state.weight;
    const double rate_off = (rate_rad_s - share * state.rate_sum_rad_s).cwiseAbs().maxCoeff();
    const double force_off = (force_m_s2 - share * state.force_sum_m_s2).cwiseAbs().maxCoeff();
    if (rate_off > params_.rate_spread_rad_s || force_off > params_.force_spread_m_s2) state.weight = 0.0;
  }
  const double force = force_m_s2.norm();
  if ((rate_rad_s - bias_rad_s).cwiseAbs().maxCoeff() > params_.rate_max_rad_s + params_.rate_spread_rad_s ||
      force < params_.caller_settings.force_min_m_s2 || force > params_.caller_settings.force_max_m_s2) {
    state.weight = 0.0;
    state.small_rate_since_ns = 0;
    return false;
  }
  if (state.weight == 0.0) {
    state.first_ns = from_ns;
    state.rate_sum_rad_s.setZero();
    state.force_sum_m_s2.setZero();
  } else if (seconds(to_ns - state.first_ns) > params_.caller_settings.memory_s) {
    const double keep = 1.0 - std::min(1.0, step_s / params_.caller_settings.memory_s);
    state.weight *= keep;
    state.rate_sum_rad_s *= keep;
    state.force_sum_m_s2 *= keep;
  }
  state.rate_sum_rad_s += rate_rad_s;
  state.force_sum_m_s2 += force_m_s2;
  state.weight += 1.0;
  const bool is_bias =
      (state.rate_sum_rad_s / state.weight - bias_rad_s).cwiseAbs().maxCoeff() <= params_.rate_max_rad_s;
  state.small_rate_since_ns = is_bias ? to_ns - state.first_ns : 0;
  state.is_stationary = is_bias && seconds(state.small_rate_since_ns) >= params_.rest_s;
  return state.is_stationary;
}

std::vector<bool> RestDetector::find(std::span<const ImuSample> samples, const Eigen::Vector3d& bias_rad_s) const {
  std::vector<bool> rest(samples.size(), false);
  State state;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!detect_stationary(samples[k], state, bias_rad_s)) continue;
    for (std::size_t i = k + 1; i-- > 0 && samples[i].time_ns >= state.first_ns && !rest[i];) rest[i] = true;
  }
  return rest;
}

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
