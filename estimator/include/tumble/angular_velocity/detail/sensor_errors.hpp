// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Constant errors of gyro and accelerometer other than bias and noise. A vector of the 29 errors has the order of the
/// members, with matrices row by row.
struct SensorErrors {
  static constexpr int kSize = 29, kAccel = 9, kGSensitivity = 18, kDelay = 27, kAccelFilterTimeVariance = 28;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// Errors of scale and misalignment. The gyro reads (1 + gyro) rate + g_sensitivity_fraction force + bias. The
  /// accelerometer reads (1 + accel) force + bias.
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Zero(), accel = Eigen::Matrix3d::Zero();
  /// sensitivity of the gyro to specific force [rad/s per m/s^2]
  Eigen::Matrix3d g_sensitivity_s_m = Eigen::Matrix3d::Zero();
  /// delay of the accelerometer relative to the gyro [s]
  double accel_delay_s = 0.0;
  /// Variance of time over the averaging window (impulse response) of the accelerometer, minus the same variance of the
  /// gyro [s^2].
  double accel_filter_time_variance_s2 = 0.0;

  Vector vector() const;
  static SensorErrors from(const Vector& values);
  bool operator==(const SensorErrors&) const = default;
};

struct KnownSensorErrors {
  SensorErrors errors;
  SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
};

/// Checks sensor errors from earlier runs. Returns `out_of_range` if an error exceeds 0.2, or if the covariance has a
/// negative eigenvalue.
Status check_known_errors(const KnownSensorErrors& earlier_runs);
/// Throws InvalidParams if a sensor error exceeds 0.2, or if the covariance has a negative eigenvalue.
void require_valid_known_errors(const KnownSensorErrors& earlier_runs);

/// Prior standard deviations of sensor errors, for a calibrated and for an uncalibrated device, in the units of
/// SensorErrors. The function fit_sensor_errors() weights both priors by how well they explain the readings.
struct SensorErrorPriors {
  /// Standard deviations of scale and misalignment. The defaults of the calibrated device are from the data sheet of
  /// the MTi-300: non-orthogonality 0.05 deg. The defaults of the uncalibrated device are from the MPU-6050: 3 % scale
  /// and 2 % cross-axis error, taken as three standard deviations.
  double gyro = 5e-4, gyro_uncalibrated = 0.01;
  double accel = 5e-4, accel_uncalibrated = 0.01;
  /// Standard deviations of the g-sensitivity. The defaults are 0.003 deg/s/g for a calibrated device and 0.1 deg/s/g
  /// for an uncalibrated device.
  double g_sensitivity_s_m = 5.3e-6, g_sensitivity_uncalibrated_s_m = 1.8e-4;
  /// Standard deviations of the accelerometer's delay relative to the gyro. In a calibrated device, gyro and
  /// accelerometer have equal filters; in an uncalibrated device, separate filters. The prior of
  /// accel_filter_time_variance_s2 is proportional to the square of the delay's standard deviation.
  double delay_s = 1e-4, delay_uncalibrated_s = 5e-3;

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

/// Returns the prior standard deviations of all sensor errors. `share` is between 0 (calibrated device) and 1
/// (uncalibrated device).
SensorErrors::Vector prior_sigmas(const SensorErrorPriors& sizes, double share);

/// Quadratic approximation of the log-likelihood of a run's readings as a function of the sensor errors, expanded at
/// `linearisation_point`. `information` is minus the second derivative of the log-likelihood, and `gradient` is the
/// first derivative.
struct SensorErrorInformation {
  SensorErrors linearisation_point;
  SensorErrors::Matrix information = SensorErrors::Matrix::Zero();
  SensorErrors::Vector gradient = SensorErrors::Vector::Zero();
};

/// Multiplies by `share` the information about those combinations of sensor errors that free motion cannot determine:
/// rate_smoother.md (R39).
void discount_unobservable(double share, SensorErrorInformation& evidence);

struct SensorErrorFit {
  KnownSensorErrors fitted_errors;
  double data_sheet_probability = 1.0;          ///< probability that scale and misalignment agree with the data sheet
  double synchronous_triads_probability = 1.0;  ///< probability that gyro and accelerometer have no relative delay
};

/// Estimates the sensor errors by Bayesian model averaging over calibrated, intermediate and uncalibrated prior
/// standard deviations. `earlier_runs` is the result of evidence_from_earlier_runs(). Cost: O(1), about 30 linear
/// systems of 29 unknowns.
SensorErrorFit fit_sensor_errors(const SensorErrorInformation& evidence, const SensorErrorPriors& sizes,
                                 const SensorErrorInformation& earlier_runs = {});

/// Removes the prior from the sensor errors that earlier runs estimated. The result is their information as a
/// measurement for the next run.
SensorErrorInformation evidence_from_earlier_runs(const KnownSensorErrors& earlier_runs,
                                                  const SensorErrorPriors& sizes);

/// Computes the covariance of the scale, misalignment, g-sensitivity and delay errors of an IMU from the readings so
/// far: rate_stream.md (R102), (R103). The cost is lower than for fit_sensor_errors().
class SensorErrorUncertainty {
 public:
  /// Weight of the information of one sample; below 1, because the errors of the motion model are correlated between
  /// samples.
  static constexpr double kSensorErrorEvidenceWeight = 0.03;

  struct Posterior {
    /// covariance of the sensor errors that remain after the correction of the readings
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double uncalibrated_probability = 0.0;
  };

  /// Buffers of update(), which are too large for the stack of a thread.
  struct WorkMatrices {
    SensorErrors::Matrix normal_matrix, corrected_covariance;
  };

  /// `uncalibrated` is the prior probability that the IMU does not match its data sheet.
  SensorErrorUncertainty(const SensorErrorPriors& sizes, double uncalibrated);

  /// Computes `posterior` from `evidence`, the information of the readings about the sensor errors. If the information
  /// is not finite, `posterior` is the prior. `is_uncalibrated` states that the IMU is known to deviate from its data
  /// sheet. Cost: O(1), two systems of 29 unknowns, no allocation.
  void update(const SensorErrorInformation& evidence, WorkMatrices& work, Posterior& posterior,
              bool is_uncalibrated = false) const;

  /// Returns the odds that the delay between gyro and accelerometer agrees with the data sheet: rate_stream.md (R106).
  /// `delay_s` is the measured minus the stated delay, with the standard deviation `sigma_s`.
  double data_sheet_odds(double delay_s, double sigma_s) const;

  /// Estimates the error of the assumed delay between gyro and accelerometer from `evidence`: rate_stream.md (R107).
  /// The prior has mean 0 and standard deviation `reach_s`, and the result is limited to +-`reach_s`. Returns 0 if the
  /// information matrix is indefinite. Cost: O(1), no allocation.
  double delay_correction_s(const SensorErrorInformation& evidence, double reach_s) const;

  void reset(Posterior& posterior) const;

  /// Returns the variance of the common delay of gyro and accelerometer [s^2], which the readings do not determine.
  double common_delay_variance_s2(const Posterior& posterior) const;

 private:
  SensorErrors::Vector data_sheet_sigma_, uncalibrated_sigma_;
  double uncalibrated_prior_;
};

}  // namespace tumble
