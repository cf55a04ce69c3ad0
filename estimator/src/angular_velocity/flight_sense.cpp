// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/flight_sense.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "tumble/angular_velocity/detail/rail_shares.hpp"

namespace tumble {

namespace {

// Forces in a hand look like flight by twice the rate for 0.05 s at a time, flights of a gyro that reads half last.
constexpr double kHalvedRun_s = 0.08;

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
        in_range && (mean.device_clip_flags & kClipGyro) == 0},
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
  const Eigen::Vector3d along = ((now.rate_rad_s - first.rate_rad_s) / dt_s).cross(t), about = w.cross(w.cross(t));
  const std::array<Eigen::Vector3d, 3> expected = {along + about, -along - about, 2.0 * along + 4.0 * about};
  const bool free = first.free && middle.free && now.free;
  for (std::size_t sense = 0; sense < expected.size(); ++sense) {
    const double size = expected[sense].norm();
    const bool flies =
        free && size >= params_.force_min_m_s2 && (middle.force_m_s2 - expected[sense]).norm() <= params_.share * size;
    if (!flies) {
      state.run_s[sense] = 0.0;
      continue;
    }
    state.run_s[sense] += 0.5 * dt_s;
    if (state.run_s[sense] >= (sense == 2 ? std::max(kHalvedRun_s, params_.run_s) : params_.run_s))
      state.flown_s[sense] += 0.5 * dt_s;
  }
}

Status FlightSense::verdict(const State& state) const {
  const double sound_s = params_.against_with * state.flown_s[0];
  const double against_s = std::max(params_.against_s, sound_s), halved_s = std::max(params_.halved_s, sound_s);
  if (state.flown_s[1] > against_s)
    return {Trouble::out_of_range, "seconds of flight in which the force is that of the other sense", state.flown_s[1],
            against_s};
  if (state.flown_s[2] > halved_s)
    return {Trouble::out_of_range, "seconds of flight in which the force is that of twice the rate", state.flown_s[2],
            halved_s};
  return {};
}

}  // namespace tumble
