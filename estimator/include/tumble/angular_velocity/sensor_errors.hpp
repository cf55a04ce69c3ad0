// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Constant sensor errors other than bias and noise: 29 numbers, in this order, matrices row by row.
struct SensorErrors {
  static constexpr int kSize = 29, kAccel = 9, kFelt = 18, kDelay = 27, kBlur = 28;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// Scale and misalignment. The gyro reads (1 + gyro) rate + felt force + bias, the accelerometer (1 + accel) force +
  /// bias.
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Zero(), accel = Eigen::Matrix3d::Zero();
  /// g-sensitivity of the gyro [rad/s per m/s^2].
  Eigen::Matrix3d felt_s_m = Eigen::Matrix3d::Zero();
  /// Delay of the accelerometer relative to the gyro.
  double accel_delay_s = 0.0;
  /// Difference in window width: variance of the time weights of an accelerometer reading minus that of the gyro [s^2].
  /// Negative if the gyro's window is wider.
  double accel_blur_s2 = 0.0;

  Vector vector() const;
  static SensorErrors from(const Vector& values);
  bool operator==(const SensorErrors&) const = default;
};

/// Sensor errors with their covariance.
struct KnownSensorErrors {
  SensorErrors errors;
  SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
};

/// Throws InvalidParams for errors above 0.2 or an invalid covariance. A negative eigenvalue would act as perfect
/// knowledge.
void require_known(const KnownSensorErrors& learnt);

/// Prior standard deviations of sensor errors: those stated in a data sheet, and those of an uncalibrated device.
/// SensorErrorFit determines from the readings which of the two applies. If the second value does not exceed the first,
/// the data sheet always applies. [0, 0.1] each, units as in SensorErrors.
struct SensorErrorSizes {
  /// Data sheet of the MTi-300: non-orthogonality 0.05 deg. The MPU-6050 has 3 % scale and 2 % cross-axis error, used
  /// as 3 sigma.
  double gyro = 5e-4, gyro_unknown = 0.01;
  double accel = 5e-4, accel_unknown = 0.01;
  /// 0.003 deg/s/g; 0.1 deg/s/g.
  double felt_s_m = 5.3e-6, felt_unknown_s_m = 1.8e-4;
  /// Filters of both triads at about 400 Hz; or separate windows and filters. The window difference scales with the
  /// square of the delay.
  double delay_s = 1e-4, delay_unknown_s = 5e-3;

  /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gyro, {"gyro", "1", 0.0, 0.1,
                   "standard deviation of the gyro's scale and misalignment, device within its data sheet"});
    visit(p.gyro_unknown, {"gyro_unknown", "1", 0.0, 0.1,
                           "standard deviation of the gyro's scale and misalignment, device not calibrated"});
    visit(p.accel, {"accel", "1", 0.0, 0.1,
                    "standard deviation of the accelerometer's scale and misalignment, device within its data sheet"});
    visit(p.accel_unknown, {"accel_unknown", "1", 0.0, 0.1,
                            "standard deviation of the accelerometer's scale and misalignment, device not calibrated"});
    visit(p.felt_s_m, {"felt_s_m", "s/m", 0.0, 0.1,
                       "standard deviation of the gyro's g-sensitivity, device within its data sheet"});
    visit(p.felt_unknown_s_m, {"felt_unknown_s_m", "s/m", 0.0, 0.1,
                               "standard deviation of the gyro's g-sensitivity, device not calibrated"});
    visit(p.delay_s, {"delay_s", "s", 0.0, 0.1,
                      "standard deviation of the delay between accelerometer and gyro, if both have the same filter"});
    visit(p.delay_unknown_s,
          {"delay_unknown_s", "s", 0.0, 0.1,
           "standard deviation of the delay between accelerometer and gyro, if their filters differ"});
  }
};

/// Returns the standard deviations of all errors. `share` is between 0 (data sheet) and 1 (uncalibrated device). All
/// are above 0.
SensorErrors::Vector error_deviations(const SensorErrorSizes& sizes, double share);

/// Evidence of a run's readings about the sensor errors, about the point `about`. `information` is the second
/// derivative of the cost and `gradient` its negative first derivative, with all other unknowns at their optimum.
struct SensorErrorEvidence {
  SensorErrors about;
  SensorErrors::Matrix information = SensorErrors::Matrix::Zero();
  SensorErrors::Vector gradient = SensorErrors::Vector::Zero();
};

/// Reduces the evidence to `share` in the directions that a freely moving body does not determine. Such directions are
/// a scale common to all axes of a triad, and a common rotation of both triads. In these directions the evidence comes
/// from residuals of the motion model, which smaller motions reduce, and grows with the number of samples.
/// rate_smoother.md (R39).
void discount_untold(double share, SensorErrorEvidence& evidence);

/// Sensor errors estimated from the readings and the prior.
struct SensorErrorFit {
  KnownSensorErrors known;
  double calibrated = 1.0;  ///< probability that scale and misalignment are within the data sheet
  double together = 1.0;    ///< probability that the triads are as synchronous as the data sheet states
};

/// Estimates the sensor errors by Bayesian model averaging over prior sizes. The models combine data sheet,
/// uncalibrated, and intermediate sizes for scale and misalignment of both triads, g-sensitivity, and sampling. For
/// each model, the function computes the Gaussian posterior of the errors and the likelihood of the readings. The
/// result has the mean and covariance of the mixture. A device whose readings fit the data sheet thereby keeps a small
/// uncertainty of unobservable errors. O(1): some 30 systems of 29 unknowns.
/// `learnt`: evidence of earlier runs of the device, from learnt_evidence(), used with full weight.
SensorErrorFit fit_sensor_errors(const SensorErrorEvidence& evidence, const SensorErrorSizes& sizes,
                                 const SensorErrorEvidence& learnt = {});

/// Converts the sensor errors estimated in one run to evidence for the next. The prior of an uncalibrated device is
/// removed from the covariance because the next run adds it again.
SensorErrorEvidence learnt_evidence(const KnownSensorErrors& learnt, const SensorErrorSizes& sizes);

}  // namespace tumble
