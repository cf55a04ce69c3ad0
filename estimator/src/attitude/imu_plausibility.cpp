// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// time window in which the rotation of the specific force is compared with the rotation measured by the gyro
constexpr double kGravityWindow_s = 0.2;
constexpr double kForceReading_s = 0.02;  // averaging time of the IMU readings, independent of the sample rate
constexpr double kWindowGapMax_s = 0.1;   // in a longer data gap, the gyro may miss a rotation
// largest relative change of the specific force's magnitude in a time window with constant force
constexpr double kChangeMax = 0.12;
// The directions of two specific forces are compared only if each magnitude differs from gravity by less than the
// fraction kGravityNear.
constexpr double kGravityNear = 0.25;
// In recordings of pendulums and hand-held wands, the measured gravity rotates by 0.75 to 1.21 times the gyro's
// rotation.
constexpr double kSlopeMin = 0.65, kSlopeMax = 1.5;
// minimum sum of squared rotations over all time windows, and minimum rotation in one time window
constexpr double kRotationMin_rad2 = 0.5, kRotationMin_rad = 0.15;
// A push, or the centripetal force in free flight, may rotate the measured specific force for a few windows of 0.2 s.
constexpr double kRotatedWindowsMin = 5.0;
// A scale error of the gyro is reported only if scaling the gyro rotation reduces the unexplained rotation of the
// specific force strongly. The sum of squared unexplained rotations must decrease to less than the fraction
// kScaledResidualMax: imu_merge.md (I21). A regression gives the ratio of specific-force rotation to gyro rotation:
// imu_merge.md (I20). Pushes of the body often make the specific force rotate less than the gyro measures. If the ratio
// of specific-force rotation to gyro rotation is between 0 and 1, the stricter limit kReducedResidualMax applies.
constexpr double kScaledResidualMax = 0.75, kReducedResidualMax = 0.33;
// At gyro rates below kSlow_rad_s (slow rocking on the ground, or a gyro offset), pushes may tilt the specific force
// more than the rotation does.
constexpr double kSlow_rad_s = 0.4;
constexpr double kFrozen_s = 1.0, kRepetitionRatio = 10.0;
// A gyro counts as frozen only if the gyro rotation leaves at least the fraction kUnmeasuredMin of the specific force's
// rotation unexplained.
constexpr double kUnmeasuredMin = 0.5;
constexpr double kStandstillRad2 = 1e-6;  // largest squared rotation of a gyro at rest
// minimum difference between specific force and gravity that excludes rest, as a fraction of gravity
constexpr double kNonRestForceRatio = 0.5;
constexpr double kPushedMin_s = 0.2;  // minimum duration of a specific force that excludes rest
// minimum specific force with a usable direction, as a fraction of gravity
constexpr double kDirectionForceRatioMin = 0.05;

// See imu_merge.md (I20).
double force_gyro_rotation_product_rad2(const ImuPlausibility::State& state) {
  return 0.5 * (state.force_rotation_square_sum_rad2 + state.gyro_rotation_square_sum_rad2 -
                state.unexplained_force_rotation_rad2);
}

bool rotated_enough(const ImuPlausibility::State& state) {
  return state.force_rotation_square_sum_rad2 >= kRotationMin_rad2 && state.rotated_window_count >= kRotatedWindowsMin;
}

void add_repeated_reading(const Eigen::Vector3d& reading, double dt_s, ImuPlausibility::RepeatedReadingTime& hold) {
  if (reading != hold.reading) {
    hold.longest_s = std::max(hold.longest_s, hold.repeated_s);
    hold.repeated_s = 0.0;
    hold.changing_readings_duration_s += dt_s;
    hold.reading = reading;
    return;
  }
  hold.repeated_s += dt_s;
  const bool froze = std::min(hold.repeated_s, hold.changing_readings_duration_s) >= kFrozen_s &&
                     hold.repeated_s >= kRepetitionRatio * hold.longest_s;
  if (froze) hold.frozen_s = std::max(hold.frozen_s, hold.repeated_s);
}

/// Returns the fraction of the specific force's rotation that the gyro does not explain, or 0 if the fraction is
/// unknown.
double unexplained_force_rotation_ratio(const ImuPlausibility::State& state) {
  return rotated_enough(state) ? state.unexplained_force_rotation_rad2 /
                                     std::max(state.force_rotation_square_sum_rad2, state.gyro_rotation_square_sum_rad2)
                               : 0.0;
}

}  // namespace

ImuPlausibility::ImuPlausibility(const Setup& setup) : setup_(setup) {
  require_in_interval("gravity_m_s2", setup.gravity_m_s2, 1e-12, 100.0);
  require_in_interval("gyro_range_rad_s", setup.gyro_range_rad_s, 1e-3, 1e6);
}

void ImuPlausibility::step(const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return;
  double dt_s = 0.0;
  if (state.started) {
    const Status follows = elapsed_time_since_last(sample.time_ns, state.last_time_ns, kWindowGapMax_s, dt_s);
    if (follows.error_code == ErrorCode::time_order) return;
    if (follows.ok()) {
      // a gyro that is saturated on all axes also repeats one reading
      if (sample.angular_velocity_rad_s.cwiseAbs().minCoeff() < setup_.gyro_range_rad_s)
        add_repeated_reading(sample.angular_velocity_rad_s, dt_s, state.gyro);
      add_repeated_reading(sample.specific_force_m_s2, dt_s, state.accel);
    }
    if (!follows.ok()) {
      state.window_started = false;
      state.average = {};
      state.in_range = true;
    } else {
      state.in_range = state.in_range && sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() < setup_.gyro_range_rad_s;
      state.average.add(sample, dt_s);
      if (state.average.full(kForceReading_s, dt_s)) process_averaged_reading(state);
    }
  } else {
    state.gyro.reading = sample.angular_velocity_rad_s;
    state.accel.reading = sample.specific_force_m_s2;
  }
  state.started = true;
  state.last_time_ns = sample.time_ns;
}

/// See imu_merge.md (I18), (I19).
void ImuPlausibility::process_averaged_reading(State& state) const {
  const Eigen::Vector3d force = state.average.mean.specific_force_m_s2;
  const Eigen::Vector3d turned = state.average.length_s * state.average.mean.angular_velocity_rad_s;
  const double length_s = state.average.length_s;
  state.average = {};
  if (std::abs(force.norm() - setup_.gravity_m_s2) > kNonRestForceRatio * setup_.gravity_m_s2)
    state.moving_force_duration_s += length_s;
  if (state.window_started) {
    // The rotation between two averaged specific forces refers to the middles of the averaging intervals. As an
    // approximation, the gyro rotation between the ends of the averaging intervals is used.
    state.gyro_rotation_in_window = (state.gyro_rotation_in_window * so3::exp(turned)).normalized();
    state.length_s += length_s;
    const double start = state.window_start_force_m_s2.norm();
    state.force_is_constant = state.force_is_constant && std::abs(force.norm() - start) <= kChangeMax * start;
    if (state.length_s >= kGravityWindow_s - 0.5 * length_s) {
      if (state.force_is_constant && state.in_range) {
        compare_rotations(force, state);
      }
      state.window_started = false;
    }
  }
  if (!state.window_started) {
    state.window_start_force_m_s2 = force;
    state.gyro_rotation_in_window.setIdentity();
    state.length_s = 0.0;
    state.window_started = true;
    state.in_range = true;
    state.force_is_constant = force.norm() >= kDirectionForceRatioMin * setup_.gravity_m_s2;
  }
}

/// See imu_merge.md (I19).
void ImuPlausibility::compare_rotations(const Eigen::Vector3d& force_m_s2, State& state) const {
  const auto near_gravity = [&](const Eigen::Vector3d& force) {
    return std::abs(force.norm() - setup_.gravity_m_s2) <= kGravityNear * setup_.gravity_m_s2;
  };
  if (!near_gravity(state.window_start_force_m_s2) || !near_gravity(force_m_s2)) return;
  const Eigen::Vector3d from = state.window_start_force_m_s2.normalized(), to = force_m_s2.normalized();
  const double by_force = (to - from).squaredNorm();
  const double by_gyro = (state.gyro_rotation_in_window.conjugate() * from - from).squaredNorm();
  if (by_force < kRotationMin_rad * kRotationMin_rad) return;
  state.force_rotation_square_sum_rad2 += by_force;
  state.gyro_rotation_square_sum_rad2 += by_gyro;
  state.unexplained_force_rotation_rad2 += (to - state.gyro_rotation_in_window.conjugate() * from).squaredNorm();
  state.rotated_window_count += 1.0;
}

void ImuPlausibility::limit_memory(State& state) {
  constexpr double kWindowsMax = 300.0;  // a minute of windows of 0.2 s
  for (RepeatedReadingTime* hold : {&state.gyro, &state.accel}) {
    if (hold->repeated_s == 0.0) hold->frozen_s = 0.0;
  }
  if (state.rotated_window_count <= kWindowsMax) return;
  const double share = kWindowsMax / state.rotated_window_count;
  for (double* sum : {&state.unexplained_force_rotation_rad2, &state.force_rotation_square_sum_rad2,
                      &state.gyro_rotation_square_sum_rad2, &state.rotated_window_count})
    *sum *= share;
}

/// If the reading of a sensor has never changed, the sensor counts as frozen only while the body moves. A rotating
/// specific force, or a specific force that excludes rest, proves that the body moves. An accelerometer that reads zero
/// for longer than a free fall is frozen if the gyro measures rotation.
double ImuPlausibility::frozen_s(const State& state) const {
  const auto never_moved = [&](const RepeatedReadingTime& hold) {
    return hold.changing_readings_duration_s == 0.0 && hold.repeated_s >= kFrozen_s;
  };
  const bool rotation_unmeasured = unexplained_force_rotation_ratio(state) >= kUnmeasuredMin;
  const bool gyro = never_moved(state.gyro) && (rotation_unmeasured || state.moving_force_duration_s >= kPushedMin_s);
  const bool accel = never_moved(state.accel) && state.accel.reading.isZero(0.0) &&
                     state.gyro.changing_readings_duration_s >= kFrozen_s;
  return std::max({state.gyro.frozen_s, state.accel.frozen_s, gyro ? state.gyro.repeated_s : 0.0,
                   accel ? state.accel.repeated_s : 0.0});
}

/// See imu_merge.md (I20).
double ImuPlausibility::force_to_gyro_rotation_ratio(const State& state) const {
  if (!rotated_enough(state)) return 1.0;
  return force_gyro_rotation_product_rad2(state) / std::max(state.gyro_rotation_square_sum_rad2, kStandstillRad2);
}

double ImuPlausibility::rotation_agreement(const State& state) const {
  if (!rotated_enough(state)) return 1.0;
  return force_gyro_rotation_product_rad2(state) /
         std::sqrt(state.force_rotation_square_sum_rad2 *
                   std::max(state.gyro_rotation_square_sum_rad2, kStandstillRad2));
}

/// See imu_merge.md (I21).
bool ImuPlausibility::fits_better(const State& state) const {
  const double slope = force_to_gyro_rotation_ratio(state), agreement = rotation_agreement(state);
  const double left = state.force_rotation_square_sum_rad2 * (1.0 - agreement * agreement);
  // Pushes of the body often change the ratio of specific-force rotation to gyro rotation, but rarely to values below 0
  // or above 1.5. During slow rotation, pushes may change the ratio of specific-force rotation to gyro rotation to any
  // value.
  const double slow_rad = kSlow_rad_s * kGravityWindow_s;
  const bool pushed = (slope > 0.0 && slope < 1.0) ||
                      state.gyro_rotation_square_sum_rad2 < state.rotated_window_count * slow_rad * slow_rad;
  const double most = pushed ? kReducedResidualMax : kScaledResidualMax;
  return left < most * state.unexplained_force_rotation_rad2;
}

Status ImuPlausibility::verdict(const State& state) const {
  if (const double frozen = frozen_s(state); frozen > 0.0) {
    return {ErrorCode::out_of_range, "time in s for which gyro or accelerometer repeats one reading", frozen,
            kFrozen_s};
  }
  const double slope = force_to_gyro_rotation_ratio(state);
  if ((slope > kSlopeMax || slope < kSlopeMin) && fits_better(state))
    return {ErrorCode::out_of_range, "ratio of gravity's rotation (accelerometer) to the rotation measured by the gyro",
            slope, slope < kSlopeMin ? kSlopeMin : kSlopeMax};
  return {};
}

}  // namespace tumble
