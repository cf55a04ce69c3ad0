// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

namespace {

constexpr double kFlightReading_s = 0.01;  // averaging time of IMU readings, independent of the sample rate
constexpr double kLeverArmMax_m = 1e3;
constexpr double kForceMin_m_s2 = 2.5;  // a smaller specific force of the rotation is mostly noise and bias
// tolerated difference between measured and predicted specific force in free flight, as a fraction of the prediction
constexpr double kTolerance = 0.25;
// minimum time for which the readings must agree with free flight; motion on the ground rarely agrees with free flight
// for longer
constexpr double kRun_s = 0.02;
constexpr double kFlightGapMax_s = 0.1;  // a longer data gap restarts the duration of agreement
constexpr double kAlternativeRatioMin = 4.0, kThrownRatioMin = 2.0;
// With one inverted accelerometer axis, motion on the ground can look like free flight for 0.17 s by chance (measured
// in scenario `hill`).
constexpr double kAlternativeMin_s = 0.2;
constexpr double kGroupsPerSide = 0.05;  // minimum squared share of the lever arm perpendicular to a saturated axis
constexpr double kBelowRail = 0.1;       // tolerated fraction by which a recovered rate is below the saturation level

struct MirroredAxes {
  std::array<double, 3> mirror_signs;
  const char* name;

  Eigen::Vector3d corrected(const Eigen::Vector3d& force) const {
    return {mirror_signs[0] * force[0], mirror_signs[1] * force[1], mirror_signs[2] * force[2]};
  }
};

constexpr std::array<MirroredAxes, FlightSignCheck::kMirroredAlternatives> kAlternativeSensors = {{
    {{1, 1, 1}, "flight time in s"},
    {{-1, -1, -1}, "flight time in s that agrees with an inverted accelerometer"},
    {{-1, 1, 1}, "flight time in s that agrees with an inverted accelerometer axis x"},
    {{1, -1, 1}, "flight time in s that agrees with an inverted accelerometer axis y"},
    {{1, 1, -1}, "flight time in s that agrees with an inverted accelerometer axis z"},
}};

/// See imu_merge.md (I32).
FlightSignCheck::AveragedReading convert_reading(const FlightSignCheck::AveragedReading& reading,
                                                 const MirroredAxes& sense, const Eigen::Vector3d& t) {
  FlightSignCheck::AveragedReading out = reading;
  out.force_m_s2 = sense.corrected(reading.force_m_s2);
  if (!reading.is_unsaturated || reading.saturation_sign.isZero(0.0)) return out;
  int axis = 0;
  out.saturation_sign.cwiseAbs().maxCoeff(&axis);
  const double sign = out.saturation_sign[axis];
  Eigen::Vector3d others = out.rate_rad_s;
  others[axis] = 0.0;
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis).cross(t), rest = others.cross(t);
  const double a = unit.squaredNorm(), b = unit.dot(rest), c = rest.squaredNorm() + out.force_m_s2.dot(t);
  const double root = b * b - a * c;
  out.is_unsaturated =
      reading.saturation_sign.cwiseAbs().sum() == 1.0 && a >= kGroupsPerSide * t.squaredNorm() && root >= 0.0;
  if (!out.is_unsaturated) return out;
  const double rate = (-b + (sign > 0.0 ? 1.0 : -1.0) * std::sqrt(root)) / a, read = out.rate_rad_s[axis];
  out.is_unsaturated = rate * read > 0.0 && std::abs(rate) >= (1.0 - kBelowRail) * std::abs(read);
  out.rate_rad_s[axis] = rate;
  return out;
}

/// See imu_merge.md (I31).
bool agrees_with_flight(const MirroredAxes& sense, const std::array<FlightSignCheck::AveragedReading, 3>& readings,
                        const FlightSignCheck::Setup& setup) {
  const Eigen::Vector3d& t = setup.lever_arm_m;
  const FlightSignCheck::AveragedReading first = convert_reading(readings[0], sense, t),
                                         middle = convert_reading(readings[1], sense, t),
                                         last = convert_reading(readings[2], sense, t);
  if (!first.is_unsaturated || !middle.is_unsaturated || !last.is_unsaturated) return false;
  const double dt_s = seconds(last.time_ns - first.time_ns);
  const Eigen::Vector3d &w = middle.rate_rad_s, alpha = (last.rate_rad_s - first.rate_rad_s) / dt_s;
  const Eigen::Vector3d expected = alpha.cross(t) + w.cross(w.cross(t));
  const double size = expected.norm();
  return size >= kForceMin_m_s2 && (middle.force_m_s2 - expected).norm() <= kTolerance * size;
}

/// On a body that may be hand-held, the only tested fault is an accelerometer with three inverted axes.
bool is_alternative_tested(std::size_t sense, FlightSignCheck::BodyMotionType body) {
  return body == FlightSignCheck::BodyMotionType::always_thrown || sense <= 1;
}

}  // namespace

FlightSignCheck::FlightSignCheck(const Setup& setup) : setup_(setup) {
  for (const double coordinate_m : setup.lever_arm_m)
    require_in_interval("lever_arm_m", coordinate_m, -kLeverArmMax_m, kLeverArmMax_m);
  require_in_interval("gyro_range_rad_s", setup.gyro_range_rad_s, 0.0, kUnbounded);
}

void FlightSignCheck::step(const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return;
  if (state.started && sample.time_ns <= state.last_time_ns) return;
  const double dt_s = state.started ? seconds(sample.time_ns - state.last_time_ns) : 0.0;
  const bool follows = state.started && dt_s <= kFlightGapMax_s;
  state.started = true;
  state.last_time_ns = sample.time_ns;
  if (!follows) {
    state.average = {};
    state.readings = 0;
    state.current_flight_duration_s = {};
    return;
  }
  state.average.add(sample, dt_s);
  if (!state.average.full(kFlightReading_s, dt_s)) return;
  const ImuSample& mean = state.average.mean;
  process_reading(reading_of(mean, state.average.rate_peak_rad_s), state);
  state.average = {};
}

FlightSignCheck::AveragedReading FlightSignCheck::reading_of(const ImuSample& mean, double rate_peak_rad_s) const {
  AveragedReading out{mean.time_ns, mean.angular_velocity_rad_s, mean.specific_force_m_s2, Eigen::Vector3d::Zero(),
                      true};
  const double rail = setup_.gyro_range_rad_s == 0.0 ? kUnbounded : (1.0 - kNearRailRatio) * setup_.gyro_range_rad_s;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flagged = (mean.device_clip_flags & (kClipGyroX << axis)) != 0;
    if (flagged || std::abs(out.rate_rad_s[axis]) >= rail)
      out.saturation_sign[axis] = out.rate_rad_s[axis] < 0.0 ? -1.0 : 1.0;
  }
  const bool by_the_force = setup_.motion_type == BodyMotionType::always_thrown && !out.saturation_sign.isZero(0.0);
  out.is_unsaturated = by_the_force || (rate_peak_rad_s < rail && out.saturation_sign.isZero(0.0));
  return out;
}

void FlightSignCheck::process_reading(const AveragedReading& now, State& state) const {
  const auto [first, middle] = state.last_readings;
  state.last_readings = {middle, now};
  if (state.readings < 2) {
    ++state.readings;
    return;
  }
  const double dt_s = seconds(now.time_ns - first.time_ns);
  for (std::size_t sense = 0; sense < kMirroredAlternatives; ++sense) {
    if (!is_alternative_tested(sense, setup_.motion_type)) continue;
    if (!agrees_with_flight(kAlternativeSensors[sense], {first, middle, now}, setup_)) {
      state.current_flight_duration_s[sense] = 0.0;
      continue;
    }
    state.current_flight_duration_s[sense] += 0.5 * dt_s;
    if (state.current_flight_duration_s[sense] < kRun_s) continue;
    state.flight_duration_s[sense] += 0.5 * dt_s;
    if (sense != 0) state.last_flight_end_ns = now.time_ns;
  }
}

Status FlightSignCheck::current_verdict(const State& state) const {
  const bool old =
      check_stamp_order(state.last_time_ns, state.last_flight_end_ns, kForgettingTime_s).error_code == ErrorCode::gap;
  return old ? Status{} : verdict(state);
}

Status FlightSignCheck::verdict(const State& state) const {
  const double ratio = setup_.motion_type == BodyMotionType::always_thrown ? kThrownRatioMin : kAlternativeRatioMin;
  const double bound_s = std::max(kAlternativeMin_s, ratio * state.flight_duration_s[0]);
  const auto longest = std::max_element(state.flight_duration_s.begin() + 1, state.flight_duration_s.end());
  if (*longest <= bound_s) return {};
  const auto sense = static_cast<std::size_t>(longest - state.flight_duration_s.begin());
  return {ErrorCode::out_of_range, kAlternativeSensors[sense].name, *longest, bound_s};
}

}  // namespace tumble
