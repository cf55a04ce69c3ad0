// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/attitude/detail/imu_merge_state.hpp"
#include "tumble/attitude/detail/imu_plausibility.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

/// All readings of one of several IMUs on a body, in time order.
struct ImuRecording {
  ImuDataSheet data_sheet;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  std::vector<ImuSample> samples;
};

struct MergedRecordings {
  /// Calibration of one IMU relative to the mean of all IMUs.
  struct MergedImu {
    std::size_t imu_index = 0;
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< positive: the IMU lags behind the mean
    double rate_bias_rad_s = 0.0;
  };
  std::vector<ImuSample> samples;                         ///< fused samples, in body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< mean position of the IMUs, in body axes
  std::vector<MergedImu> imus;                            ///< IMUs in use
  /// IMUs that are silent, frozen, or contradict the other IMUs, and are therefore excluded. An IMU with a frozen axis
  /// is excluded only during the fault.
  SensorHealth faults;
  std::size_t excluded_readings = 0;
  std::optional<double> lever_arm_agreement;
  std::optional<MultiImuSignCheck::DetectedMirroring>
      mislabelled_axes;  ///< flipped or swapped axes that all IMUs share
};

ClippingFinder::Params clipping_finder_params(const ImuDataSheet& sheet);
/// Selects from the saturation limits `detected` those that a frozen IMU cannot imitate.
ConfirmedSaturation confirmed_saturation(const SaturationLevels& detected, const ImuDataSheet& sheet);

/// Returns the name of an IMU in health findings: "imu_1" for index 0, or "imu" if there is only one IMU.
std::string imu_name(std::size_t unit, std::size_t units);

/// Fuses the recordings of up to ImuMerge::kImus IMUs on one body, with the saturation limits and faults of the whole
/// recording. ClippingFinder flags the clipped readings, ImuTimeAlignment resamples the IMUs to common times, and
/// ImuMerge fuses them. An IMU is excluded while an axis is frozen or readings are missing. If ImuMerge detects a
/// frozen or contradicting IMU, a second pass excludes this IMU from the start of the fault. IMUs without samples are
/// ignored. `setup` states the ranges; the function sets the number, poses and sensing elements of the IMUs.
///
/// Returns `empty` if no IMU has a sample, or an error of ImuMerge. Returns `out_of_range` with the axis if frozen axes
/// leave no IMU; `out.faults` then lists the excluded IMUs. Cost: O(N).
Status merge_recordings(std::span<const ImuRecording> recordings, ImuMerge::Setup setup, MergedRecordings& out);

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
