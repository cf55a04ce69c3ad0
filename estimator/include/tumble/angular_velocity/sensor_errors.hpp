// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Constant sensor errors other than bias and noise: 29 numbers, in the order of the members, matrices row by row.
struct SensorErrors {
  static constexpr int kSize = 29, kAccel = 9, kGSensitivity = 18, kDelay = 27, kFilterTimeVariance = 28;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// Errors of scale and misalignment. The gyro reads (1 + gyro) rate + g_sensitivity force + bias. The accelerometer
  /// reads (1 + accel) force + bias.
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Zero(), accel = Eigen::Matrix3d::Zero();
  /// g-sensitivity of the gyro [rad/s per m/s^2].
  Eigen::Matrix3d g_sensitivity_s_m = Eigen::Matrix3d::Zero();
  /// Delay of the accelerometer relative to the gyro.
  double accel_delay_s = 0.0;
  /// Difference in window width: variance of the time weights of an accelerometer reading minus that of the gyro [s^2].
  /// Negative if the gyro's window is wider.
  double accel_filter_time_variance_s2 = 0.0;

  Vector vector() const;
  static SensorErrors from(const Vector& values);
  bool operator==(const SensorErrors&) const = default;
};

/// Sensor errors with their covariance.
struct KnownSensorErrors {
  SensorErrors errors;
  SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
};

/// Throws InvalidParams for errors above 0.2 or an invalid covariance. A negative eigenvalue would make the filter
/// treat a direction as perfectly known.
void require_known(const KnownSensorErrors& learnt);

/// Prior standard deviations of sensor errors: those stated in a data sheet, and those of an uncalibrated device.
/// SensorErrorFit determines from the readings whether the data sheet applies. If the uncalibrated value does not
/// exceed the data sheet's value, the data sheet always applies. Each value is in [0, 0.1], with the units of
/// SensorErrors.
struct SensorErrorSizes {
  /// Standard deviations of scale and misalignment. The data sheet of the MTi-300 states a non-orthogonality of 0.05
  /// deg. The MPU-6050 has 3 % scale and 2 % cross-axis error, used as 3 sigma.
  double gyro = 5e-4, gyro_uncalibrated = 0.01;
  double accel = 5e-4, accel_uncalibrated = 0.01;
  /// Standard deviations of the g-sensitivity: 0.003 deg/s/g by the data sheet and 0.1 deg/s/g uncalibrated.
  double g_sensitivity_s_m = 5.3e-6, g_sensitivity_uncalibrated_s_m = 1.8e-4;
  /// Standard deviations of the delay: both filters at about 400 Hz, or separate windows and filters when uncalibrated.
  /// The window difference scales with the square of the delay.
  double delay_s = 1e-4, delay_uncalibrated_s = 5e-3;

  /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gyro, {"gyro", "1", 0.0, 0.1,
                   "standard deviation of the gyro's scale and misalignment, device within its data sheet"});
    visit(p.gyro_uncalibrated, {"gyro_uncalibrated", "1", 0.0, 0.1,
                                "standard deviation of the gyro's scale and misalignment, device not calibrated"});
    visit(p.accel, {"accel", "1", 0.0, 0.1,
                    "standard deviation of the accelerometer's scale and misalignment, device within its data sheet"});
    visit(p.accel_uncalibrated,
          {"accel_uncalibrated", "1", 0.0, 0.1,
           "standard deviation of the accelerometer's scale and misalignment, device not calibrated"});
    visit(p.g_sensitivity_s_m, {"g_sensitivity_s_m", "s/m", 0.0, 0.1,
                                "standard deviation of the gyro's g-sensitivity, device within its data sheet"});
    visit(p.g_sensitivity_uncalibrated_s_m, {"g_sensitivity_uncalibrated_s_m", "s/m", 0.0, 0.1,
                                             "standard deviation of the gyro's g-sensitivity, device not calibrated"});
    visit(p.delay_s, {"delay_s", "s", 0.0, 0.1,
                      "standard deviation of the delay between accelerometer and gyro, if both have the same filter"});
    visit(p.delay_uncalibrated_s,
          {"delay_uncalibrated_s", "s", 0.0, 0.1,
           "standard deviation of the delay between accelerometer and gyro, if their filters differ"});
  }
};

/// Returns the standard deviations of all errors. `share` is between 0 (data sheet) and 1 (uncalibrated device). All
/// returned values are above 0.
SensorErrors::Vector error_deviations(const SensorErrorSizes& sizes, double share);

/// Quadratic log-likelihood of a run's readings as a function of the sensor errors, expanded at `about`. `information`
/// is the second derivative of the cost and `gradient` its negative first derivative, with all other unknowns at their
/// optimum.
struct SensorErrorEvidence {
  SensorErrors about;
  SensorErrors::Matrix information = SensorErrors::Matrix::Zero();
  SensorErrors::Vector gradient = SensorErrors::Vector::Zero();
};

/// Multiplies the information by `share` in the directions that a freely moving body does not determine. The
/// unobservable directions are a scale common to all axes of a triad, and a common rotation of gyro and accelerometer.
/// In unobservable directions, the information comes from residuals of the motion model. Smaller motions reduce the
/// residuals, and the information grows with the number of samples. rate_smoother.md (R39).
void discount_unobservable(double share, SensorErrorEvidence& evidence);

/// Sensor errors estimated from the readings and the prior.
struct SensorErrorFit {
  KnownSensorErrors known;
  double in_sheet_probability = 1.0;     ///< probability that scale and misalignment are within the data sheet
  double synchronous_probability = 1.0;  ///< probability that the triads are as synchronous as the data sheet states
};

/// Estimates the sensor errors by Bayesian model averaging over prior sizes. The models combine data sheet,
/// uncalibrated, and intermediate sizes for scale and misalignment of both triads, g-sensitivity, and sampling. For
/// each model, the function computes the Gaussian posterior of the errors and the likelihood of the readings. The
/// result has the mean and covariance of the mixture. A device whose readings fit the data sheet thereby keeps a small
/// uncertainty of unobservable errors. Cost: O(1), some 30 systems of 29 unknowns.
/// `learnt` is information from earlier runs of the device, from calibration_evidence(), used with full weight.
SensorErrorFit fit_sensor_errors(const SensorErrorEvidence& evidence, const SensorErrorSizes& sizes,
                                 const SensorErrorEvidence& learnt = {});

/// Converts the sensor errors estimated in one run to measurement information for the next run. The prior of an
/// uncalibrated device is removed from the covariance because the next run adds that prior again.
SensorErrorEvidence calibration_evidence(const KnownSensorErrors& learnt, const SensorErrorSizes& sizes);

}  // namespace tumble
