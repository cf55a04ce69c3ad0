// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/detail/sensor_errors.hpp"

namespace tumble {

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
