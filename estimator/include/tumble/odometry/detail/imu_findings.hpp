// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/attitude/detail/imu_plausibility.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

namespace tumble {

struct ImuDescription {
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< ranges from the data sheet; 0: unknown
  double gravity_m_s2 = 9.80665;
  /// lever arm from the centre of mass to the IMU, in IMU axes
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Zero();
  /// true: the samples are the fused readings of several IMUs, whose rates may exceed the range of each IMU
  bool is_merged = false;
};

struct ImuHealthReport {
  SensorHealth health;
  std::vector<FrozenAxis> frozen_axes;  ///< intervals with a frozen axis, sorted by axis and time
};

/// Returns the setup of the check of gyro against gravity. `gyro_range_rad_s` is from the data sheet; 0: unknown.
ImuPlausibility::Setup plausibility_setup(double gravity_m_s2, double gyro_range_rad_s);

/// Returns true if the rotation of gravity, measured by the accelerometer, confirms the gyro's scale. If forces of
/// several IMUs then contradict each other, the cause is a mounting or an accelerometer.
bool confirms_gyro(const ImuPlausibility& plausibility, const ImuPlausibility::State& state);

void add_findings(const ImuPlausibility& plausibility, const ImuPlausibility::State& state, const std::string& sensor,
                  SensorHealth& health);

/// Checks units, signs and axes of gyro and accelerometer with the magnitude and rotation of gravity, and with rotation
/// about a pivot (PivotMotionCheck). Cost: about 1 ms per second of data at 100 Hz.
SensorHealth check_readings(const ImuDescription& imu, std::span<const ImuSample> samples);

/// Cost: O(N).
ImuHealthReport check_frozen(const ImuDescription& imu, std::span<const ImuSample> samples);

/// Runs all checks: check_readings(), specific force in free flight, motion from rest to rest, and frozen axes.
/// `carried_share` is the fraction of hand-held samples. If the body was never hand-held, the flight check also detects
/// single flipped or swapped axes, and uses flights with a clipped gyro axis.
ImuHealthReport check_recording(const ImuDescription& imu, std::span<const ImuSample> samples,
                                std::span<const AngularRateState> rates, std::optional<double> carried_share);

struct MergedImuRecording {
  MergedRecordings recordings;
  SensorHealth health;
};

struct MergedImuChecks {
  RestGravity rest_gravity;
  ImuPlausibility plausibility;
  std::array<RestGravity::GravityMagnitudeState, ImuMerge::kImus> rest_gravity_state{};
  ImuPlausibility::State plausibility_state{};
};

/// Checks single IMUs, the fused readings, and the differences between the IMUs, which also show inverted signs and
/// exchanged axes. Cost: O(N).
SensorHealth check_merged_imus(const ImuDescription& imu, const MergedRecordings& merged);

/// Returns the covariance that suspected faults add to each rate, or an empty list without such faults. If readings
/// contradict each other, the standard deviation is the rate itself; a flipped sign, for example, gives an error of
/// twice the rate. While a gyro axis is frozen, the standard deviation is the largest rate of the recording. Cost:
/// O(N).
std::vector<Eigen::Matrix3d> suspected_error_covariance(const ImuHealthReport& findings,
                                                        std::span<const ImuSample> samples,
                                                        std::span<const AngularRateState> rates);

}  // namespace tumble
