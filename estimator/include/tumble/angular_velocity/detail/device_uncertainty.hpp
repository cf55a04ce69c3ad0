// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/detail/sensor_errors.hpp"

namespace tumble {

/// Computes the uncertainty of a device's sensor errors from the readings of the run so far, at lower cost than
/// fit_sensor_errors(): rate_stream.md (R102), (R103).
class SensorErrorUncertainty {
 public:
  /// weight of one sample; below 1, because flight model errors are correlated between samples
  static constexpr double kSensorErrorEvidenceWeight = 0.03;

  struct Posterior {
    /// covariance of the sensor errors after correction of the readings
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double uncalibrated_probability = 0.0;  ///< probability that the device does not match its data sheet
  };

  /// Buffers of update(), which are too large for the stack of a thread.
  struct WorkMatrices {
    SensorErrors::Matrix normal_matrix, corrected_covariance;
  };

  /// `uncalibrated` is the prior probability that the device does not match its data sheet.
  SensorErrorUncertainty(const SensorErrorPriors& sizes, double uncalibrated);

  /// Computes `posterior` from `evidence`, the information of the readings about the sensor errors. If the information
  /// is not finite, `posterior` is the prior. `is_uncalibrated` states that the device is known to deviate from its
  /// data sheet. Cost: O(1), two systems of 29 unknowns, no allocation.
  void update(const SensorErrorInformation& evidence, WorkMatrices& work, Posterior& posterior,
              bool is_uncalibrated = false) const;

  /// Returns the likelihood ratio of synchronous to asynchronous gyro and accelerometer: rate_stream.md (R106).
  /// `delay_s` is a measured delay minus the known delay, with the standard deviation `sigma_s`.
  double data_sheet_odds(double delay_s, double sigma_s) const;

  /// Estimates the remaining delay of the accelerometer from `evidence`: rate_stream.md (R107). The prior of the delay
  /// has mean 0 and standard deviation `reach_s`, and the result is limited to +-`reach_s`. Returns 0 if the
  /// information is indefinite. Cost: O(1), no allocation.
  double delay_correction_s(const SensorErrorInformation& evidence, double reach_s) const;

  void reset(Posterior& posterior) const;

  /// Returns the variance of a delay common to gyro and accelerometer [s^2], which no measurement determines.
  double common_delay_variance_s2(const Posterior& posterior) const;

 private:
  SensorErrors::Vector data_sheet_sigma_, uncalibrated_sigma_;  ///< standard deviations
  double uncalibrated_prior_;
};

}  // namespace tumble
