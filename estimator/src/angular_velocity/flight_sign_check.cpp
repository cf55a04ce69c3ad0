// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/rail_ratios.hpp"

namespace tumble {

namespace {

// A flight of at least kHalfScaleRun_s proves that a gyro reports half the true rate. With doubled rates, hand-held
// motion looks like flight for up to 0.05 s. Real flights are longer.
constexpr double kHalfScaleRun_s = 0.08;
constexpr double kAcross = 0.05;    // (minimum lever arm component across a saturated axis)^2 / |lever arm|^2
constexpr double kBelowRail = 0.1;  // fraction of the reading by which a recovered rate may be below it

struct Axes {
  std::array<int, 3> axis;
  std::array<double, 3> factor;

  Eigen::Vector3d of(const Eigen::Vector3d& reading) const {
    return {factor[0] * reading[axis[0]], factor[1] * reading[axis[1]], factor[2] * reading[axis[2]]};
  }
};

constexpr Axes kUnchangedAxes{{0, 1, 2}, {1, 1, 1}}, kXFlipped{{0, 1, 2}, {-1, 1, 1}}, kYFlipped{{0, 1, 2}, {1, -1, 1}},
    kZFlipped{{0, 1, 2}, {1, 1, -1}}, kFlipped{{0, 1, 2}, {-1, -1, -1}}, kXYSwapped{{1, 0, 2}, {1, 1, 1}},
    kYZSwapped{{0, 2, 1}, {1, 1, 1}}, kZXSwapped{{2, 1, 0}, {1, 1, 1}}, kTwice{{0, 1, 2}, {2, 2, 2}},
    kHalf{{0, 1, 2}, {0.5, 0.5, 0.5}};

/// ReadingHypothesis is a possible fault of a sensor (sign, axis order or scale). `force` and `rate` convert the faulty
/// readings to correct readings.
struct ReadingHypothesis {
  Axes force, rate;
  const char* name;
};

constexpr std::array<ReadingHypothesis, FlightSignCheck::kAlternatives> kReadingHypotheses = {{
    {kUnchangedAxes, kUnchangedAxes, "flight time in s"},
    {kFlipped, kUnchangedAxes, "flight time in s that agrees with an inverted accelerometer"},
    {kXFlipped, kUnchangedAxes, "flight time in s that agrees with an inverted accelerometer axis x"},
    {kYFlipped, kUnchangedAxes, "flight time in s that agrees with an inverted accelerometer axis y"},
    {kZFlipped, kUnchangedAxes, "flight time in s that agrees with an inverted accelerometer axis z"},
    {kXYSwapped, kUnchangedAxes, "flight time in s that agrees with exchanged accelerometer axes x and y"},
    {kYZSwapped, kUnchangedAxes, "flight time in s that agrees with exchanged accelerometer axes y and z"},
    {kZXSwapped, kUnchangedAxes, "flight time in s that agrees with exchanged accelerometer axes z and x"},
    {kUnchangedAxes, kFlipped, "flight time in s that agrees with an inverted gyro"},
    {kUnchangedAxes, kXFlipped, "flight time in s that agrees with an inverted gyro axis x"},
    {kUnchangedAxes, kYFlipped, "flight time in s that agrees with an inverted gyro axis y"},
    {kUnchangedAxes, kZFlipped, "flight time in s that agrees with an inverted gyro axis z"},
    {kUnchangedAxes, kXYSwapped, "flight time in s that agrees with exchanged gyro axes x and y"},
    {kUnchangedAxes, kYZSwapped, "flight time in s that agrees with exchanged gyro axes y and z"},
    {kUnchangedAxes, kZXSwapped, "flight time in s that agrees with exchanged gyro axes z and x"},
    {kUnchangedAxes, kHalf, "flight time in s that agrees with a gyro that reads twice the true rate"},
    {kUnchangedAxes, kTwice, "flight time in s that agrees with a gyro that reads half the true rate"},
}};

/// Corrects a reading for a hypothetical sign, axis order or scale of the sensor: imu_merge.md (I32). The rate of a
/// single saturated axis follows from the centripetal force. `known` is false if the recovered rate contradicts the
/// saturated reading.
FlightSignCheck::Reading convert_reading(const FlightSignCheck::Reading& reading, const ReadingHypothesis& sense,
                                         const Eigen::Vector3d& t) {
  FlightSignCheck::Reading out = reading;
  out.rate_rad_s = sense.rate.of(reading.rate_rad_s);
  out.force_m_s2 = sense.force.of(reading.force_m_s2);
  out.at_rail = sense.rate.of(reading.at_rail);
  if (!reading.known || reading.at_rail.isZero(0.0)) return out;
  int axis = 0;
  out.at_rail.cwiseAbs().maxCoeff(&axis);
  const double sign = out.at_rail[axis];
  Eigen::Vector3d others = out.rate_rad_s;
  others[axis] = 0.0;
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis).cross(t), rest = others.cross(t);
  const double a = unit.squaredNorm(), b = unit.dot(rest), c = rest.squaredNorm() + out.force_m_s2.dot(t);
  const double root = b * b - a * c;
  out.known = reading.at_rail.cwiseAbs().sum() == 1.0 && a >= kAcross * t.squaredNorm() && root >= 0.0;
  if (!out.known) return out;
  const double rate = (-b + (sign > 0.0 ? 1.0 : -1.0) * std::sqrt(root)) / a, read = out.rate_rad_s[axis];
  out.known = rate * read > 0.0 && std::abs(rate) >= (1.0 - kBelowRail) * std::abs(read);
  out.rate_rad_s[axis] = rate;
  return out;
}

/// Returns whether the middle one of three readings agrees with flight, after correction of the hypothetical fault:
/// imu_merge.md (I31).
bool agrees_with_flight(const ReadingHypothesis& sense, const std::array<FlightSignCheck::Reading, 3>& readings,
                        const FlightSignCheck::Params& params) {
  const Eigen::Vector3d& t = params.lever_arm_m;
  const FlightSignCheck::Reading first = convert_reading(readings[0], sense, t),
                                 middle = convert_reading(readings[1], sense, t),
                                 last = convert_reading(readings[2], sense, t);
  if (!first.known || !middle.known || !last.known) return false;
  const double dt_s = seconds(last.time_ns - first.time_ns);
  const Eigen::Vector3d &w = middle.rate_rad_s, alpha = (last.rate_rad_s - first.rate_rad_s) / dt_s;
  const Eigen::Vector3d expected = alpha.cross(t) + w.cross(w.cross(t));
  const double size = expected.norm();
  return size >= params.force_min_m_s2 && (middle.force_m_s2 - expected).norm() <= params.share * size;
}

/// Returns whether the check tests a hypothesis about a sensor fault. For a body that may be hand-held, the check tests
/// three hypotheses: no fault, an inverted force and a gyro with half scale.
bool is_tested(std::size_t sense, FlightSignCheck::Body body) {
  constexpr std::size_t kSound = 0, kFlippedForce = 1;
  return body == FlightSignCheck::Body::thrown || sense == kSound || sense == kFlippedForce ||
         sense == FlightSignCheck::kHalfScaleGyro;
}

}  // namespace

FlightSignCheck::FlightSignCheck(const Params& params) : params_(params) {
  require_valid_fields(params);
}

void FlightSignCheck::step(const ImuSample& sample, State& state) const {
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
  process_reading(reading_of(mean, state.average.rate_peak_rad_s), state);
  state.average = {};
}

FlightSignCheck::Reading FlightSignCheck::reading_of(const ImuSample& mean, double rate_peak_rad_s) const {
  Reading out{mean.time_ns, mean.angular_velocity_rad_s, mean.specific_force_m_s2, Eigen::Vector3d::Zero(), true};
  const double rail = params_.gyro_range_rad_s == 0.0 ? kUnbounded : (1.0 - kNearRailRatio) * params_.gyro_range_rad_s;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flagged = (mean.device_clip_flags & (kClipGyroX << axis)) != 0;
    if (flagged || std::abs(out.rate_rad_s[axis]) >= rail) out.at_rail[axis] = out.rate_rad_s[axis] < 0.0 ? -1.0 : 1.0;
  }
  const bool by_the_force = params_.body == Body::thrown && !out.at_rail.isZero(0.0);
  out.known = by_the_force || (rate_peak_rad_s < rail && out.at_rail.isZero(0.0));
  return out;
}

/// Classifies the previous reading as flight or not. The angular acceleration of the previous reading follows from the
/// readings before and after it.
void FlightSignCheck::process_reading(const Reading& now, State& state) const {
  const auto [first, middle] = state.before;
  state.before = {middle, now};
  if (state.readings < 2) {
    ++state.readings;
    return;
  }
  const double dt_s = seconds(now.time_ns - first.time_ns);
  for (std::size_t sense = 0; sense < kAlternatives; ++sense) {
    if (!is_tested(sense, params_.body)) continue;
    if (!agrees_with_flight(kReadingHypotheses[sense], {first, middle, now}, params_)) {
      state.run_s[sense] = 0.0;
      continue;
    }
    state.run_s[sense] += 0.5 * dt_s;
    if (state.run_s[sense] < (sense == kHalfScaleGyro ? std::max(kHalfScaleRun_s, params_.run_s) : params_.run_s))
      continue;
    state.flight_duration_s[sense] += 0.5 * dt_s;
    if (sense != 0) state.last_flight_end_ns = now.time_ns;
  }
}

Status FlightSignCheck::current_verdict(const State& state) const {
  const bool old =
      check_stamp_order(state.last_time_ns, state.last_flight_end_ns, kMemory_s).error_code == ErrorCode::gap;
  return old ? Status{} : verdict(state);
}

Status FlightSignCheck::verdict(const State& state) const {
  const bool thrown = params_.body == Body::thrown;
  const double sound_s =
      (thrown ? params_.thrown_ratio_min : params_.alternative_ratio_min) * state.flight_duration_s[0];
  std::size_t longest = 0;
  double most_s = 0.0;
  for (std::size_t sense = 1; sense < kAlternatives; ++sense) {
    const double bound_s =
        std::max(sense == kHalfScaleGyro ? params_.half_scale_flight_min_s : params_.alternative_flight_min_s, sound_s);
    if (state.flight_duration_s[sense] <= bound_s || state.flight_duration_s[sense] <= state.flight_duration_s[longest])
      continue;
    longest = sense;
    most_s = bound_s;
  }
  if (longest == 0) return {};
  return {ErrorCode::out_of_range, kReadingHypotheses[longest].name, state.flight_duration_s[longest], most_s};
}

}  // namespace tumble
