// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/detail/sensor_errors.hpp"

namespace tumble {

/// Computes the uncertainty of a device's sensor errors from the readings of the run so far. The prior is a mixture of
/// two cases: the device matches its data sheet, or is uncalibrated (SensorErrorPriors). DeviceUncertainty needs less
/// computation than fit_sensor_errors(). See rate_stream.md (R102), (R103).
class DeviceUncertainty {
 public:
  /// Weight of the samples in estimates of the sensor errors. The weight is below 1 because the errors of the flight
  /// model are correlated between samples. fit_sensor_errors() uses the same weight.
  static constexpr double kEvidenceWeight = 0.03;

  struct Posterior {
    /// Covariance of the sensor errors that remain after the correction of the readings.
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double uncalibrated_probability = 0.0;  ///< probability that the device does not match its data sheet
  };

  /// Work contains the buffers of update(), which are too large for the stack of a robot's thread.
  struct Work {
    SensorErrors::Matrix system, corrected_covariance;
  };

  /// The argument `uncalibrated` is the prior probability of an uncalibrated device.
  DeviceUncertainty(const SensorErrorPriors& sizes, double uncalibrated);

  /// Computes `posterior` from `evidence`, the information of the readings about the sensor errors. Cost: O(1), two
  /// systems of 29 unknowns, no allocation. If the information is not finite, `posterior` is the prior. The argument
  /// `is_uncalibrated` states that the device is known to deviate from its data sheet.
  void update(const SensorErrorEvidence& evidence, Work& work, Posterior& posterior,
              bool is_uncalibrated = false) const;

  /// Returns the likelihood ratio of two cases: gyro and accelerometer are synchronous as in the data sheet, or
  /// asynchronous. See rate_stream.md (R106). The argument `delay_s` is a measured delay minus the known delay, and
  /// `sigma_s` is its standard deviation.
  double data_sheet_odds(double delay_s, double sigma_s) const;

  /// Estimates the remaining delay of the accelerometer from `evidence`. The delay has a zero-mean prior with the
  /// standard deviation `reach_s`, and the result is limited to +-`reach_s`. See rate_stream.md (R107). Cost: O(1), no
  /// allocation. Returns 0 if the information is indefinite.
  double delay_correction_s(const SensorErrorEvidence& evidence, double reach_s) const;

  /// Resets the posterior to the prior.
  void reset(Posterior& posterior) const;

  /// Returns the variance of a delay common to gyro and accelerometer [s^2]. If a device deviates from its data sheet,
  /// no measurement determines the common delay.
  double common_delay_variance_s2(const Posterior& posterior) const;

 private:
  SensorErrors::Vector data_sheet_sigma_, uncalibrated_sigma_;  ///< standard deviations
  double uncalibrated_prior_;
};

}  // namespace tumble
