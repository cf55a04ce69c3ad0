// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/detail/axis_labels.hpp"
#include "tumble/attitude/detail/pivot_check.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

/// The functions in imu_findings.hpp check whether the readings of an IMU over a whole recording are plausible.
namespace tumble {

/// CheckedImu contains the known properties of the checked IMU.
struct CheckedImu {
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< ranges from the data sheet; 0: unknown
  double gravity_m_s2 = 9.80665;
  /// Lever arm from the centre of mass to the IMU, in IMU axes.
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Zero();
  /// True for several IMUs merged into one, which reports rates beyond the range of one IMU.
  bool merged = false;
};

/// ImuFinding is one implausible property of the readings.
struct ImuFinding {
  enum class Kind : std::uint8_t {
    rate_unit,                  ///< rates are possibly not in rad/s
    rest_force,                 ///< the force at rest differs from gravity (RestGravity)
    gravity_rotation_mismatch,  ///< gravity does not rotate as the gyro measures, or a sensor is frozen
                                ///< (ImuPlausibility)
    flight,                     ///< forces in flight contradict lever arm, axes or signs (FlightSignCheck)
    rest_rotation_mismatch,     ///< the rates do not rotate gravity correctly between rests (RestGravity)
    pivot_rotation_mismatch,    ///< the rates do not rotate the body correctly about pivots (PivotCheck)
    frozen_axis,                ///< `axis` repeats one reading (FrozenAxes)
  };
  Kind kind = Kind::rate_unit;
  Status status;        ///< implausible quantity, its value and the violated limit
  TimeNs since_ns = 0;  ///< frozen_axis: first sample of the repetition; otherwise the first sample of the recording
  FrozenAxis axis = {};
};

/// ImuFindings contains findings about an IMU, and the measured quantities of the checks that ran.
struct ImuFindings {
  struct Readings {
    double rest_force_ratio = 1.0;  ///< RestGravity::magnitude_error_ratio
    double force_ratio = 1.0;       ///< the following members: see ImuPlausibility
    double unexplained_rotation_ratio = 0.0;
    double rotation_slope = 1.0, rotation_agreement = 1.0;
    double frozen_s = 0.0;
    std::optional<AxisLabels> better_axis_labels;
    /// Returns whether the rotation of gravity confirms the gyro's scale. If forces still contradict each other, the
    /// mounting or the accelerometer is wrong.
    bool confirms_gyro() const;
  };
  std::vector<ImuFinding> all;
  std::optional<Readings> readings;
  std::optional<RestGravity::State> rests;
  std::optional<PivotCheck::Found> pivots;

  /// Returns whether the readings contradict each other or gravity. Findings of the kinds `rate_unit` and `frozen_axis`
  /// do not count.
  bool contradict() const;
  void add(const ImuFindings& other);
};

/// Checks units, signs and axes of the readings with the magnitude and rotation of gravity. Cost: O(N).
ImuFindings check_readings(const CheckedImu& imu, std::span<const ImuSample> samples);

/// Checks the forces in flights. The argument `carried_share` is the fraction of hand-held samples. If the body was
/// never hand-held, the check also detects flipped and swapped axes, and uses flights with a clipped axis. Cost: O(N).
ImuFindings check_flights(const CheckedImu& imu, std::span<const ImuSample> samples,
                          std::optional<double> carried_share);

/// Checks that `rates`, one per sample, rotate gravity correctly from each rest to the next rest. Cost: O(N).
ImuFindings check_rests(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates);

/// Checks that a body with a pivot rotates as the estimated `rates` state. The check uses only rates whose source is
/// `measured`. Cost: about 1 ms per second of data at 100 Hz.
ImuFindings check_pivots(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates);

/// Finds frozen axes, sorted by axis and time. Cost: O(N).
ImuFindings check_frozen(const CheckedImu& imu, std::span<const ImuSample> samples);

/// Runs all checks for a recording with its estimated rates.
ImuFindings check_recording(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates,
                            std::optional<double> carried_share);

/// Returns the covariance that the findings add to each rate, or an empty list without such findings. If the readings
/// contradict each other, the standard deviation is the rate itself. A flipped sign gives an error of twice the rate,
/// and a scale of one half gives an error of half the rate. While a gyro axis is frozen, the standard deviation is the
/// largest reading of the recording. Cost: O(N).
std::vector<Eigen::Matrix3d> suspect_covariance(const ImuFindings& findings, std::span<const ImuSample> samples,
                                                std::span<const RateState> rates);

}  // namespace tumble
