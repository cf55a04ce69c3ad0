// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rigid_forces.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// tolerated rate difference between IMUs due to scale errors, as a fraction of the rate
constexpr double kRateToleranceRatio = 0.03;

constexpr double kBiasSigma_rad_s = 0.01, kScaleSigma = 0.01;
constexpr double kOffsetSigma_s = 3e-3;  // prior standard deviation of each IMU's time offset
// An IMU is excluded if its difference from the median of all IMUs exceeds the rate tolerance or the force tolerance.
constexpr double kRateTolerance_rad_s = 0.15, kForceTolerance_m_s2 = 3.0;
constexpr double kHiddenForce_m_s2 = 3.0;  // largest force error attributed to saturation during a part of the window
constexpr double kRotating_rad_s2 = 1.0;   // minimum angular acceleration for estimating a time offset
constexpr double kCertainDeviations = 4.0;
constexpr int kMinImusForRecovery = 3;
constexpr double kUnsaturatedForceRatio = 0.8;  // fraction of the range up to which accelerometer errors are estimated
constexpr int kOffset = ImuMerge::kErrorCount - 1;
// The lever arm effect is the specific force that rotation causes at the IMU's distance from the mean IMU position.
// lever_arm_agreement() returns a value only if the time integral of the squared lever arm effects reaches
// kArmSquareMin_m2_s3. For example, if a lever arm effect of 1 m/s^2 lasts 1 s, an accelerometer bias of 0.05 m/s^2
// changes lever_arm_agreement() by at most 0.05.
constexpr double kArmSquareMin_m2_s3 = 1.0;
constexpr double kRepeated_s = 0.03;
constexpr double kWindowMax_s = 0.05;  // maximum window for a central difference

// After an impact, an accelerometer that contradicts the other accelerometers is excluded for kSuspect_s, because
// impacts often occur in quick succession.
constexpr double kSuspect_s = 0.04;
// standard deviation of the angular acceleration in a time window, as a fraction of the change of angular acceleration
// since the previous time window
constexpr double kAccelerationSigmaRatio = 0.3;

const ImuMergeSetup& checked(const ImuMergeSetup& setup) {
  require_in_interval("count", setup.count, 1.0, ImuMerge::kImus);
  require_in_interval("gyro_range_rad_s", setup.gyro_range_rad_s, 1e-12, 1e3);
  require_in_interval("accel_range_m_s2", setup.accel_range_m_s2, 1e-12, 1e5);
  for (int k = 0; k < setup.count; ++k) {
    const Eigen::Isometry3d& T = setup.T_mean_imu[static_cast<std::size_t>(k)];
    require_in_interval("T_CI", T.translation().norm(), 0.0, 1e3);
    require_in_interval("T_CI", (T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-6);
  }
  return setup;
}

Eigen::Vector3d mean_position_m(const ImuMergeSetup& setup) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 0; k < setup.count; ++k)
    mean += setup.T_mean_imu[static_cast<std::size_t>(k)].translation() / setup.count;
  return mean;
}

}  // namespace

ImuMerge::ImuMerge(const Setup& setup)
    : setup_(checked(setup)),
      mean_imu_position_m_(mean_position_m(setup)),
      forces_(setup),
      rate_recovery_(setup, mean_imu_position_m_) {}

Status ImuMerge::step(std::span<const ImuSample> samples, State& state, std::optional<ImuSample>& merged) const {
  merged.reset();
  if (samples.size() != static_cast<std::size_t>(setup_.count)) {
    return {ErrorCode::insufficient_data, "samples", static_cast<double>(samples.size()),
            static_cast<double>(setup_.count)};
  }
  const bool received =
      std::any_of(samples.begin(), samples.end(), [](const ImuSample& s) { return check_sample(s).ok(); });
  if (!received) return check_sample(samples[0]);
  double dt_s = 0.0;
  if (state.sample_count > 0) {
    const Status bad = elapsed_time_since_last(samples[0].time_ns, state.last_time_ns, Setup::kGapMax_s, dt_s);
    if (!bad.ok()) return bad;
  } else {
    for (Unit& unit : state.imus) {
      unit.covariance.diagonal().setConstant(kScaleSigma * kScaleSigma);
      unit.covariance.diagonal().head<3>().setConstant(kBiasSigma_rad_s * kBiasSigma_rad_s);
      unit.covariance(kOffset, kOffset) = kOffsetSigma_s * kOffsetSigma_s;
    }
  }
  accumulate_window(samples, dt_s, state);
  const bool full = state.sample_count == 0 || state.window_s >= Setup::kWindow_s - 0.5 * dt_s;
  state.last_time_ns = samples[0].time_ns;
  ++state.sample_count;
  if (full) merged = merge(state);
  return {};
}

void ImuMerge::accumulate_window(std::span<const ImuSample> samples, double dt_s, State& state) const {
  const double weight_s = state.sample_count > 0 ? dt_s : Setup::kWindow_s;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Unit& unit = state.imus[k];
    if (!check_sample(samples[k]).ok()) {
      if (unit.missing_samples++ == 0) unit.missing_since_ns = samples[0].time_ns;
      continue;
    }
    ImuSample sample = samples[k];
    for (int axis = 0; axis < 3; ++axis) {
      int flags = sample.device_clip_flags;
      if (std::abs(sample.angular_velocity_rad_s[axis]) >= setup_.gyro_range_rad_s) flags |= kClipGyroX << axis;
      if (std::abs(sample.specific_force_m_s2[axis]) >= setup_.accel_range_m_s2) flags |= kClipAccelX << axis;
      sample.device_clip_flags = static_cast<std::uint8_t>(flags);
    }
    unit.window.add(sample, weight_s);
  }
  state.window_s += dt_s;
}

ImuSample ImuMerge::merge(State& state) const {
  const auto count = static_cast<std::size_t>(setup_.count);
  const double h = state.window_s;
  const TimeNs time_ns = state.last_time_ns;
  Readings readings{};
  ImuMask finite{}, present{};
  Vectors raw_rates, raw_forces, rates{}, forces{};
  raw_rates.fill(Eigen::Vector3d::Zero());  // IMUs without readings keep zero
  raw_forces.fill(Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < count; ++k) {
    finite[k] = state.imus[k].window.readings > 0;
    if (!finite[k]) continue;
    readings[k] = state.imus[k].window.mean;
    const Eigen::Matrix3d R_CI = setup_.T_mean_imu[k].linear();
    raw_rates[k] = R_CI * readings[k].angular_velocity_rad_s;
    raw_forces[k] = R_CI * readings[k].specific_force_m_s2;
  }
  detect_frozen_units(finite, raw_rates, raw_forces, h, time_ns, state);
  const double since_s = 0.5 * (h + state.length_s);  // time between the middles of the last two averaging windows
  for (std::size_t k = 0; k < count; ++k) {
    const Unit& unit = state.imus[k];
    present[k] = finite[k] && !unit.is_excluded();
    rates[k] = raw_rates[k];
    forces[k] = raw_forces[k];
    const double offset_s = unit.offset_s();
    const bool late = offset_s * offset_s > kCertainDeviations * kCertainDeviations * unit.covariance(kOffset, kOffset);
    if (finite[k] && state.window_count > 0 && late) {  // delay of the IMU: imu_merge.md (I4)
      rates[k] -= offset_s / since_s * (raw_rates[k] - unit.last_rate_rad_s);
      forces[k] -= offset_s / since_s * (raw_forces[k] - unit.last_force_m_s2);
    }
    forces[k] = ForceErrors::corrected(static_cast<int>(k), forces[k], state.forces);
  }
  state.all_frozen = true;
  for (std::size_t k = 0; k < count; ++k)
    state.all_frozen = state.all_frozen && (!finite[k] || state.imus[k].is_frozen);
  if (std::none_of(present.begin(), present.end(), [](bool one) { return one; })) present = finite;

  const ImuMask used = select_agreeing_imus(readings, present, rates, forces, h, state);
  ImuSample merged = mean_of_selected_imus(rates, forces, used, h, state);
  merged.device_clip_flags = combined_flags(readings, used);
  const bool railed = (combined_flags(readings, present) & kClipGyro) != 0;
  const bool silent = !std::all_of(finite.begin(), finite.begin() + setup_.count, [](bool one) { return one; });
  state.unclipped_windows = railed || silent ? 0 : std::min(state.unclipped_windows + 1, kAngularAccelerationWindows);
  merged.time_ns = time_ns;
  const bool all_used = std::count(used.begin(), used.end(), true) == setup_.count;
  close_comparison_windows(present, raw_rates, raw_forces, all_used, merged, state);

  if (std::count(present.begin(), present.end(), true) >= kMinImusForRecovery) {
    recover_saturated_rate(readings, present, h, state, merged);
  } else {
    state.rate_recovery.running = false;  // a prediction across a data gap is invalid
  }
  const auto suspect = [](const Unit& unit) { return unit.exclusion_left_s > 0.0; };
  if (2 * std::count_if(state.imus.begin(), state.imus.begin() + setup_.count, suspect) > setup_.count) {
    merged.device_clip_flags =
        static_cast<std::uint8_t>(merged.device_clip_flags | kClipAccelX | kClipAccelY | kClipAccelZ);
  }
  return merged;
}

/// Selects unsaturated IMUs that agree with the median of all IMUs: imu_merge.md (I5).
ImuMerge::ImuMask ImuMerge::select_agreeing_imus(const Readings& readings, const ImuMask& present, const Vectors& rates,
                                                 const Vectors& forces, double h, State& state) const {
  const Eigen::Vector3d middle_rate = median(rates, present), middle_force = median(forces, present);
  const auto units = std::count(present.begin(), present.end(), true);
  const double rate_tolerance = kRateTolerance_rad_s + kRateToleranceRatio * middle_rate.norm();
  ImuMask used{};
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!present[i]) continue;
    const double turned =
        (setup_.T_mean_imu[i].translation() - mean_imu_position_m_).norm() * middle_rate.squaredNorm() * 2.0;
    const bool agrees = units < 3 || ((rates[i] - middle_rate).norm() < rate_tolerance &&
                                      (forces[i] - middle_force).norm() < kForceTolerance_m_s2 + turned);
    // With three or more IMUs, AngularRateRecovery uses the reading of a clipped gyro as a lower bound of the rate.
    const int clipping = units < kMinImusForRecovery ? kClipAccel | kClipGyro : kClipAccel;
    used[i] = agrees && (readings[i].device_clip_flags & clipping) == 0;
  }
  const auto kept = std::count(used.begin(), used.end(), true);
  // If no majority of the IMUs agrees, no faulty IMU can be identified, and all available IMUs are used.
  if (units < kMinImusForRecovery ? kept == 0 : 2 * kept <= units && kept < units) used = present;
  const bool apart = state.window_count > 0 && h > 0.0;  // derivatives from the last averaging window exist
  if (units >= kMinImusForRecovery && apart && middle_rate.cwiseAbs().maxCoeff() < setup_.gyro_range_rad_s) {
    exclude_partly_saturated(readings, present, forces, middle_rate, h, state, used);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(setup_.count); ++i)
    state.imus[i].excluded_window_count += !used[i];
  return used;
}

/// See imu_merge.md (I1), (I2).
ImuSample ImuMerge::mean_of_selected_imus(const Vectors& rates, const Vectors& forces, const ImuMask& used, double h,
                                          const State& state) const {
  const auto kept = static_cast<int>(std::count(used.begin(), used.end(), true));
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero(), position = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    rate += rates[i] / kept;
    force += forces[i] / kept;
    position += setup_.T_mean_imu[i].translation() / kept;
    if (kept < setup_.count) position += ForceErrors::position_error_m(static_cast<int>(i), state.forces) / kept;
  }
  if (kept < setup_.count) {
    const Eigen::Vector3d d = mean_imu_position_m_ - position;
    const double since_s = 0.5 * (h + state.length_s);
    if (state.window_count > 0 && h > 0.0) force += ((rate - state.rate_rad_s) / since_s).cross(d);
    force += rate.cross(rate.cross(d));
  }
  ImuSample merged;
  merged.angular_velocity_rad_s = rate;
  merged.specific_force_m_s2 = force;
  return merged;
}

/// Returns the ratio of measured to expected specific-force differences between the IMUs: imu_merge.md (I8).
std::optional<double> ImuMerge::lever_arm_agreement(const State& state) {
  if (state.lever_arm_effect_power < kArmSquareMin_m2_s3) return std::nullopt;
  return state.lever_arm_correlation / state.lever_arm_effect_power;
}

void ImuMerge::close_comparison_windows(const ImuMask& present, const Vectors& rates, const Vectors& forces,
                                        bool all_used, const ImuSample& merged, State& state) const {
  const double length_s = state.window_count > 0 ? state.window_s : Setup::kWindow_s;
  const bool follows = state.window_count > 1 && length_s < kWindowMax_s;
  // An IMU that repeats its reading may be frozen, unless all IMUs repeat their readings at a constant rate.
  const auto end = state.imus.begin() + setup_.count;
  const auto any_repeats = [&](Repetition Unit::*hold) {
    const auto holding = std::count_if(state.imus.begin(), end,
                                       [&](const Unit& unit) { return (unit.*hold).repeated_s >= kRepeated_s; });
    return holding > 0 && holding < setup_.count;
  };
  const bool repeated = any_repeats(&Unit::repeated_rate) || any_repeats(&Unit::repeated_force);
  const bool free = state.unclipped_windows == kAngularAccelerationWindows;
  if (all_used && !repeated && setup_.count > 1 && follows && free) calibrate(rates, state);
  detect_disagreeing_units(present, rates, forces, merged.time_ns, state);
  for (std::size_t k = 0; k < static_cast<std::size_t>(setup_.count); ++k) {
    Unit& unit = state.imus[k];
    if (unit.window.readings > 0) {
      unit.last_rate_rad_s = rates[k];
      unit.last_force_m_s2 = forces[k];
    } else {  // the last reading is outdated: use the merged motion of the other IMUs
      const Eigen::Vector3d& rate = merged.angular_velocity_rad_s;
      unit.last_rate_rad_s = rate;
      unit.last_force_m_s2 = merged.specific_force_m_s2 +
                             rate.cross(rate.cross(setup_.T_mean_imu[k].translation() - mean_imu_position_m_));
    }
    unit.window = {};
  }
  state.previous_rate_rad_s = state.rate_rad_s;
  state.rate_rad_s = merged.angular_velocity_rad_s;
  state.previous_length_s = state.length_s;
  state.length_s = length_s;
  state.window_s = 0.0;
  ++state.window_count;
}

/// Excludes accelerometers that an impact may have saturated for a part of the averaging window: imu_merge.md (I6). If
/// no two IMUs agree, the function first estimates a common angular acceleration within the averaging window:
/// imu_merge.md (I7).
void ImuMerge::exclude_partly_saturated(const Readings& samples, const ImuMask& present, const Vectors& forces,
                                        const Eigen::Vector3d& rate, double h, State& state, ImuMask& used) const {
  const double since_s = 0.5 * (h + state.length_s);
  const double window_centre_step_s = 0.5 * (state.length_s + state.previous_length_s);
  const Eigen::Vector3d before = (state.rate_rad_s - state.previous_rate_rad_s) / window_centre_step_s;
  RigidBodyImuForces rigid;
  rigid.imu_present = present;
  rigid.force_m_s2 = forces;
  rigid.rate_rad_s = rate;
  rigid.acceleration_rad_s2 = (rate - state.rate_rad_s) / since_s;
  rigid.uncertainty_rad_s2 = kAccelerationSigmaRatio * (rigid.acceleration_rad_s2 - before).norm();
  rigid.unsaturated_peak_max_m_s2 = Setup::kSubsampleSaturationRatio * setup_.accel_range_m_s2;
  rigid.tolerated_saturation_m_s2 = kHiddenForce_m_s2;
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k]) continue;
    const Eigen::Vector3d& force = samples[k].specific_force_m_s2;
    rigid.position_m[k] =
        setup_.T_mean_imu[k].translation() + ForceErrors::position_error_m(static_cast<int>(k), state.forces);
    rigid.peak_m_s2[k] = force.cwiseAbs().maxCoeff();
    rigid.force_change_m_s2[k] = (setup_.T_mean_imu[k].linear() * force - state.imus[k].last_force_m_s2).norm();
  }
  RigidBodyImuForces::AgreeingImuForces agreed = rigid.largest_agreeing_set();
  if (agreed.agreeing_imu_count == 0) {
    rigid.acceleration_rad_s2 += rigid.mean_imu_acceleration();
    rigid.uncertainty_rad_s2 = 0.0;
    agreed = rigid.largest_agreeing_set();
  }
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k]) continue;
    double& exclusion_left_s = state.imus[k].exclusion_left_s;
    const bool fits = k == agreed.imu || rigid.forces_agree(k, agreed.imu);
    exclusion_left_s = fits ? std::max(0.0, exclusion_left_s - h) : kSuspect_s;
    used[k] = used[k] && exclusion_left_s == 0.0;
  }
  if (std::none_of(used.begin(), used.begin() + setup_.count, [](bool one) { return one; })) used[agreed.imu] = true;
}

void ImuMerge::recover_saturated_rate(const Readings& readings, const ImuMask& present, double h, State& state,
                                      ImuSample& merged) const {
  Readings corrected = readings;
  for (std::size_t k = 0; k < static_cast<std::size_t>(setup_.count); ++k) {
    if (!present[k]) {
      corrected[k].angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if ((readings[k].device_clip_flags & kClipAccel) != 0) continue;
    const Eigen::Matrix3d R_CI = setup_.T_mean_imu[k].linear();
    const Eigen::Vector3d force = R_CI * readings[k].specific_force_m_s2;
    corrected[k].specific_force_m_s2 =
        R_CI.transpose() * ForceErrors::corrected(static_cast<int>(k), force, state.forces);
  }
  rate_recovery_.step({corrected.data(), static_cast<std::size_t>(setup_.count)}, h, state.rate_recovery, merged);
}

/// See imu_merge.md (I3), (I8).
void ImuMerge::calibrate(const Vectors& rates, State& state) const {
  const auto count = static_cast<std::size_t>(setup_.count);
  Eigen::Vector3d now = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    now += rates[k] / static_cast<double>(count);
    mean += state.imus[k].last_rate_rad_s / static_cast<double>(count);
  }
  const double window_centre_step_s = 0.5 * (state.window_s + state.previous_length_s) + state.length_s;
  const Eigen::Vector3d acceleration = (now - state.previous_rate_rad_s) / window_centre_step_s;
  Vectors forces{};
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero();
  double peak = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    forces[k] = state.imus[k].last_force_m_s2;
    mean_force += forces[k] / static_cast<double>(count);
    peak = std::max(peak, forces[k].cwiseAbs().maxCoeff());
  }
  if (peak < kUnsaturatedForceRatio * setup_.accel_range_m_s2) {
    forces_.calibrate({forces.data(), count}, mean, acceleration, state.length_s, state.forces);
  }
  const Eigen::Matrix3d jacobian_position = so3::hat(acceleration) + so3::hat(mean) * so3::hat(mean);
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d from_mean_m = setup_.T_mean_imu[k].translation() - mean_imu_position_m_,
                          by_rotation = jacobian_position * from_mean_m;
    state.imu_sign_check.add(forces[k] - mean_force, from_mean_m, mean, acceleration, state.length_s);
    // the lever arm effects of all IMUs sum to zero, so the mean force cancels
    state.lever_arm_correlation += state.length_s * by_rotation.dot(forces[k]);
    state.lever_arm_effect_power += state.length_s * by_rotation.squaredNorm();
  }
  if (acceleration.norm() < kRotating_rad_s2) return;
  const double variance = Setup::kRateNoise_rad_s * Setup::kRateNoise_rad_s;
  for (std::size_t k = 0; k < count; ++k) {
    Unit& unit = state.imus[k];
    const Eigen::Vector3d residual = unit.last_rate_rad_s - mean;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix<double, kErrorCount, 1> row = Eigen::Matrix<double, kErrorCount, 1>::Zero();
      row[axis] = 1.0;
      row.segment<3>(3 + 3 * axis) = mean;
      row[kOffset] = acceleration[axis];
      unit.x += scalar_update(row, residual[axis] - row.dot(unit.x), variance, unit.covariance);
    }
    unit.covariance = (0.5 * (unit.covariance + unit.covariance.transpose())).eval();
  }
}

}  // namespace tumble
