// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/attitude/detail/timing.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kStandstillRad2 = 1e-6;    // largest squared rotation of a gyro at rest
constexpr double kNonRestForceRatio = 0.5;  // difference from gravity that excludes rest, as a fraction of gravity
constexpr double kPushedMin_s = 0.2;        // minimum duration of a force that excludes rest
constexpr double kDirectionForceRatioMin = 0.05;  // minimum force with a usable direction, as a fraction of gravity

auto best_axis_residual(const ImuPlausibility::State& state) {
  return std::min_element(state.unexplained_rad2.begin(), state.unexplained_rad2.end());
}

// Returns the scalar product of the rotations that gyro and specific force measure: imu_merge.md (I20). The product a b
// follows from |a - b|^2 = |a|^2 + |b|^2 - 2 a b.
double rotation_product_rad2(const ImuPlausibility::State& state) {
  return 0.5 * (state.force_rotation_rad2 + state.gyro_rotation_rad2 - state.unexplained_rad2.front());
}

}  // namespace

ImuPlausibility::ImuPlausibility(const Params& p) : params_(p) {
  require_valid_fields(p);
}

void ImuPlausibility::step(const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return;
  double dt_s = 0.0;
  if (state.started) {
    const Status follows = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
    if (follows.error_code == ErrorCode::time_order) return;
    if (follows.ok()) {
      hold(sample.angular_velocity_rad_s, dt_s, state.gyro);
      hold(sample.specific_force_m_s2, dt_s, state.accel);
    }
    if (!follows.ok()) {
      state.window_started = false;
      state.average = {};
      state.in_range = true;
    } else {
      state.in_range = state.in_range && sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() < params_.gyro_range_rad_s;
      state.average.add(sample, dt_s);
      if (state.average.full(params_.reading_s, dt_s)) process_average(state);
    }
  } else {
    state.gyro.reading = sample.angular_velocity_rad_s;
    state.accel.reading = sample.specific_force_m_s2;
  }
  state.started = true;
  state.last_time_ns = sample.time_ns;
}

void ImuPlausibility::hold(const Eigen::Vector3d& reading, double dt_s, Repetition& hold) const {
  if (reading != hold.reading) {
    hold.longest_s = std::max(hold.longest_s, hold.repeated_s);
    hold.repeated_s = 0.0;
    hold.changing_duration_s += dt_s;
    hold.reading = reading;
    return;
  }
  hold.repeated_s += dt_s;
  const bool froze = hold.repeated_s >= params_.expert.frozen.repeats_s &&
                     hold.changing_duration_s >= params_.expert.frozen.repeats_s &&
                     hold.repeated_s >= params_.expert.frozen.repetition_ratio_min * hold.longest_s;
  if (froze) hold.frozen_s = std::max(hold.frozen_s, hold.repeated_s);
}

/// Adds an averaged reading to the window in which the rotations of gyro and specific force are compared: imu_merge.md
/// (I18), (I19).
void ImuPlausibility::process_average(State& state) const {
  const Eigen::Vector3d force = state.average.mean.specific_force_m_s2;
  const Eigen::Vector3d turned = state.average.length_s * state.average.mean.angular_velocity_rad_s;
  const double length_s = state.average.length_s;
  state.average = {};
  if (std::abs(force.norm() - params_.gravity_m_s2) > kNonRestForceRatio * params_.gravity_m_s2)
    state.non_rest_force_s += length_s;
  if (state.window_started) {
    // Each averaged force is valid at the centre of its averaging interval. The rotation between two forces is
    // therefore the sum of the rotations in between, plus half of the first and last. To first order, this equals the
    // sum of all rotations except the first.
    state.gyro_rotation = (state.gyro_rotation * so3::exp(turned)).normalized();
    state.length_s += length_s;
    const double start = state.force_start_m_s2.norm();
    state.force_is_constant =
        state.force_is_constant && std::abs(force.norm() - start) <= params_.magnitude_change_ratio_max * start;
    if (state.length_s >= params_.window_s - 0.5 * length_s) {
      if (state.force_is_constant && state.in_range) {
        state.force_sum_m_s2 += force.norm();
        state.windows += 1.0;
        compare_rotations(force, state);
      }
      state.window_started = false;
    }
  }
  if (!state.window_started) {
    state.force_start_m_s2 = force;
    state.gyro_rotation.setIdentity();
    state.length_s = 0.0;
    state.window_started = true;
    state.in_range = true;
    state.force_is_constant = force.norm() >= kDirectionForceRatioMin;
  }
}

/// Adds the rotations of gyro and specific force in a window of constant force magnitude to the sums: imu_merge.md
/// (I19), (I22).
void ImuPlausibility::compare_rotations(const Eigen::Vector3d& force_m_s2, State& state) const {
  const auto near_gravity = [&](const Eigen::Vector3d& force) {
    return std::abs(force.norm() - params_.gravity_m_s2) <= params_.gravity_difference_ratio_max * params_.gravity_m_s2;
  };
  if (!near_gravity(state.force_start_m_s2) || !near_gravity(force_m_s2)) return;
  const Eigen::Vector3d from = state.force_start_m_s2.normalized(), to = force_m_s2.normalized();
  const double by_force = (to - from).squaredNorm();
  const double by_gyro = (state.gyro_rotation.conjugate() * from - from).squaredNorm();
  const double least = params_.expert.turning.rotation_min_rad * params_.expert.turning.rotation_min_rad;
  if (std::max(by_force, by_gyro) < least) return;
  state.total_force_rotation_rad2 += by_force;
  state.total_gyro_rotation_rad2 += by_gyro;
  if (by_force < least) return;
  state.force_rotation_rad2 += by_force;
  state.gyro_rotation_rad2 += by_gyro;
  state.rotated_windows += 1.0;
  const Eigen::Matrix3d back = state.gyro_rotation.conjugate().toRotationMatrix(), forth = back.transpose();
  for (std::size_t k = 0; k < state.unexplained_rad2.size(); ++k) {
    const AxisLabels& labels = axis_labels()[k];
    const Eigen::Vector3d relabelled = labels.relabelled(from);
    const Eigen::Vector3d expected = (labels.gyro_flipped ? forth : back) * relabelled;
    state.unexplained_rad2[k] += (labels.relabelled(to) - expected).squaredNorm();
  }
}

void ImuPlausibility::limit_memory(State& state) {
  constexpr double kWindowsMax = 300.0;  // a minute of windows of 0.2 s
  for (Repetition* hold : {&state.gyro, &state.accel}) {
    if (hold->repeated_s == 0.0) hold->frozen_s = 0.0;
  }
  if (state.windows > kWindowsMax) {
    state.force_sum_m_s2 *= kWindowsMax / state.windows;
    state.windows = kWindowsMax;
  }
  if (state.rotated_windows <= kWindowsMax) return;
  const double share = kWindowsMax / state.rotated_windows;
  for (double& residual : state.unexplained_rad2) residual *= share;
  for (double* sum : {&state.force_rotation_rad2, &state.gyro_rotation_rad2, &state.total_force_rotation_rad2,
                      &state.total_gyro_rotation_rad2, &state.rotated_windows})
    *sum *= share;
}

double ImuPlausibility::force_ratio(const State& state) const {
  if (state.windows < params_.expert.force.windows_min) return 1.0;
  return state.force_sum_m_s2 / state.windows / params_.gravity_m_s2;
}

bool ImuPlausibility::rotated_enough(const State& state) const {
  return state.force_rotation_rad2 >= params_.expert.turning.rotation_min_rad2 &&
         state.rotated_windows >= params_.expert.turning.rotated_windows_min;
}

double ImuPlausibility::unexplained_rotation_ratio(const State& state) const {
  return rotated_enough(state)
             ? state.unexplained_rad2.front() / std::max(state.force_rotation_rad2, state.gyro_rotation_rad2)
             : 0.0;
}

/// Returns for how long a sensor has repeated its reading, in seconds. A sensor whose reading never changed counts as
/// frozen only while the body moves. A rotating force, or a force that excludes rest, shows that the body moves while
/// the gyro repeats. The gyro shows that the body moves while the accelerometer reads zero for longer than a free fall.
double ImuPlausibility::frozen_s(const State& state) const {
  const auto never_moved = [&](const Repetition& hold) {
    return hold.changing_duration_s == 0.0 && hold.repeated_s >= params_.expert.frozen.repeats_s;
  };
  const bool rotation_unmeasured = unexplained_rotation_ratio(state) >= params_.expert.frozen.unexplained_ratio_min;
  const bool gyro = never_moved(state.gyro) && (rotation_unmeasured || state.non_rest_force_s >= kPushedMin_s);
  const bool accel = never_moved(state.accel) && state.accel.reading.isZero(0.0) &&
                     state.gyro.changing_duration_s >= params_.expert.frozen.repeats_s;
  return std::max({state.gyro.frozen_s, state.accel.frozen_s, gyro ? state.gyro.repeated_s : 0.0,
                   accel ? state.accel.repeated_s : 0.0});
}

/// Returns the slope of a linear regression of the force's rotation on the gyro's rotation: imu_merge.md (I20).
double ImuPlausibility::rotation_slope(const State& state) const {
  if (!rotated_enough(state)) return 1.0;
  return rotation_product_rad2(state) / std::max(state.gyro_rotation_rad2, kStandstillRad2);
}

double ImuPlausibility::rotation_agreement(const State& state) const {
  if (!rotated_enough(state)) return 1.0;
  return rotation_product_rad2(state) /
         std::sqrt(state.force_rotation_rad2 * std::max(state.gyro_rotation_rad2, kStandstillRad2));
}

double ImuPlausibility::force_rotation_ratio(const State& state) const {
  return state.total_gyro_rotation_rad2 < params_.expert.turning.rotation_min_rad2
             ? 1.0
             : state.total_force_rotation_rad2 / state.total_gyro_rotation_rad2;
}

/// Returns axis labels that explain the readings better than the current labels: imu_merge.md (I22).
std::optional<AxisLabels> ImuPlausibility::better_axis_labels(const State& state) const {
  if (unexplained_rotation_ratio(state) < params_.expert.naming.unexplained_ratio_min) return std::nullopt;
  const auto least = best_axis_residual(state);
  if (*least >= params_.expert.naming.unexplained_ratio_max * state.unexplained_rad2.front()) return std::nullopt;
  return axis_labels()[static_cast<std::size_t>(least - state.unexplained_rad2.begin())];
}

/// Returns whether a different gyro scale explains the readings better than pushes of the body do: imu_merge.md (I21).
/// Pushes also rotate the measured force, but do not fit any gyro scale better than another.
bool ImuPlausibility::fits_better(const State& state) const {
  const double slope = rotation_slope(state), agreement = rotation_agreement(state);
  const double left = state.force_rotation_rad2 * (1.0 - agreement * agreement);
  // Pushes of the body often reduce the regression slope, but rarely invert it or increase it by half.
  const bool low = slope > 0.0 && slope < 1.0;
  const double most = low ? params_.expert.naming.unexplained_ratio_max : params_.expert.turning.unexplained_ratio_max;
  return left < most * state.unexplained_rad2.front();
}

Status ImuPlausibility::verdict(const State& state) const {
  const double force = force_ratio(state);
  if (force < params_.expert.force.steady_force_ratio_min) {
    return {ErrorCode::out_of_range, "mean specific force in steady windows (share of gravity)", force,
            params_.expert.force.steady_force_ratio_min};
  }
  if (force > params_.expert.force.share_max) {
    return {ErrorCode::out_of_range, "mean specific force in steady windows (share of gravity)", force,
            params_.expert.force.share_max};
  }
  if (const double frozen = frozen_s(state); frozen > 0.0) {
    return {ErrorCode::out_of_range, "time in s for which gyro or accelerometer repeats one reading", frozen,
            params_.expert.frozen.repeats_s};
  }
  if (better_axis_labels(state)) {
    const double least = *best_axis_residual(state);
    return {ErrorCode::out_of_range,
            "unexplained rotation of gravity with other gyro axes or signs, divided by the value with the stated axes",
            least / state.unexplained_rad2.front(), params_.expert.naming.unexplained_ratio_max};
  }
  if (const double still = force_rotation_ratio(state); still < params_.expert.turning.still_rotation_ratio) {
    return {ErrorCode::out_of_range, "rotation of a steady force, divided by the rotation measured by the gyro", still,
            params_.expert.turning.still_rotation_ratio};
  }
  const double slope = rotation_slope(state);
  const double least = params_.expert.turning.slope_min, most = params_.expert.turning.slope_max;
  if ((slope > most || slope < least) && fits_better(state))
    return {ErrorCode::out_of_range, "ratio of gravity's rotation (accelerometer) to the rotation measured by the gyro",
            slope, slope < least ? least : most};
  return {};
}

}  // namespace tumble
