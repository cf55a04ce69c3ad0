// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

/// Computes the uncertainty of a device's sensor errors from the readings of the run so far. The prior is a mixture of
/// two cases: the device matches its data sheet, or is uncalibrated (SensorErrorPriors). DeviceUncertainty needs less
/// computation than fit_sensor_errors(). See rate_stream.md (R102), (R103).
class DeviceUncertainty {
 public:
  /// The weight of the samples is below 1, because the errors of the flight model are correlated between samples.
  static constexpr double kEvidenceWeight = 0.03;

  struct Posterior {
    /// covariance of the sensor errors that remain after the correction of the readings
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double uncalibrated_probability = 0.0;  ///< probability that the device does not match its data sheet
  };

  /// The buffers of update() are too large for the stack of a robot's thread.
  struct Work {
    SensorErrors::Matrix system, corrected_covariance;
  };

  /// `uncalibrated` is the prior probability of an uncalibrated device.
  DeviceUncertainty(const SensorErrorPriors& sizes, double uncalibrated);

  /// Computes `posterior` from `evidence`, the information of the readings about the sensor errors. Cost: O(1), two
  /// systems of 29 unknowns, no allocation. If the information is not finite, `posterior` is the prior.
  /// `is_uncalibrated` states that the device is known to deviate from its data sheet.
  void update(const SensorErrorEvidence& evidence, Work& work, Posterior& posterior,
              bool is_uncalibrated = false) const;

  /// Returns the likelihood ratio of synchronous (as in the data sheet) to asynchronous gyro and accelerometer. See
  /// rate_stream.md (R106). `delay_s` is a measured delay minus the known delay, and `sigma_s` is its standard
  /// deviation.
  double data_sheet_odds(double delay_s, double sigma_s) const;

  /// Estimates the remaining delay of the accelerometer from `evidence`. The prior of the delay has mean 0 and standard
  /// deviation `reach_s`, and the result is limited to +-`reach_s`. See rate_stream.md (R107). Cost: O(1), no
  /// allocation. Returns 0 if the information is indefinite.
  double delay_correction_s(const SensorErrorEvidence& evidence, double reach_s) const;

  void reset(Posterior& posterior) const;

  /// Returns the variance of a delay common to gyro and accelerometer [s^2]. If a device deviates from its data sheet,
  /// no measurement determines the common delay.
  double common_delay_variance_s2(const Posterior& posterior) const;

 private:
  SensorErrors::Vector data_sheet_sigma_, uncalibrated_sigma_;  ///< standard deviations
  double uncalibrated_prior_;
};

}  // namespace tumble
