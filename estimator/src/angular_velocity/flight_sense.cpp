// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/flight_sense.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "tumble/angular_velocity/detail/rail_shares.hpp"

namespace tumble {

namespace {

constexpr unsigned kGyroFlags = kClipGyroX | kClipGyroY | kClipGyroZ;

}  // namespace

FlightSense::FlightSense(const Params& params) : params_(params) {
  require_fields(params);
}

void FlightSense::step(const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return;
  if (state.started && sample.time_ns <= state.last_time_ns) return;
  const double dt_s = state.started ? seconds(sample.time_ns - state.last_time_ns) : 0.0;
  const bool follows = state.started && dt_s <= params_.gap_max_s;
  state.started = true;
  state.last_time_ns = sample.time_ns;
  if (!follows) {
    state.average = {};
    state.readings = 0;
    state.run_s = {};
    return;
  }
  state.average.add(sample, dt_s);
  if (!state.average.full(params_.reading_s, dt_s)) return;
  const ImuSample& mean = state.average.mean;
  const double rail = (1.0 - kBesideRail) * params_.gyro_range_rad_s;
  const bool in_range = params_.gyro_range_rad_s == 0.0 || state.average.rate_peak_rad_s < rail;
  take({mean.time_ns, mean.angular_velocity_rad_s, mean.specific_force_m_s2,
        in_range && (mean.device_clip_flags & kGyroFlags) == 0},
       state);
  state.average = {};
}

/// Judges the reading before `now`, whose angular acceleration those beside it tell.
void FlightSense::take(const Reading& now, State& state) const {
  const auto [first, middle] = state.before;
  state.before = {middle, now};
  if (state.readings < 2) {
    ++state.readings;
    return;
  }
  const double dt_s = seconds(now.time_ns - first.time_ns);
  const Eigen::Vector3d &t = params_.lever_arm_m, &w = middle.rate_rad_s;
  const Eigen::Vector3d turning = ((now.rate_rad_s - first.rate_rad_s) / dt_s).cross(t) + w.cross(w.cross(t));
  const double size = turning.norm();
  const bool tells = first.free && middle.free && now.free && size >= params_.force_min_m_s2;
  for (std::size_t sense = 0; sense < 2; ++sense) {
    const Eigen::Vector3d expected = sense == 0 ? turning : Eigen::Vector3d(-turning);
    if (!tells || !((middle.force_m_s2 - expected).norm() <= params_.share * size)) {
      state.run_s[sense] = 0.0;
      continue;
    }
    state.run_s[sense] += 0.5 * dt_s;
    if (state.run_s[sense] >= params_.run_s) state.flown_s[sense] += 0.5 * dt_s;
  }
}

Status FlightSense::verdict(const State& state) const {
  const double least_s = std::max(params_.against_s, params_.against_with * state.flown_s[0]);
  if (state.flown_s[1] <= least_s) return {};
  return {Trouble::out_of_range, "seconds of flight in which the force is that of the other sense", state.flown_s[1],
          least_s};
}

}  // namespace tumble
