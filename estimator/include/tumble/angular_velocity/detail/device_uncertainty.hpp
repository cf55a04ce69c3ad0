// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

/// Computes the uncertainty of a device's sensor errors from growing measurement information. The prior is a mixture of
/// two devices: one that matches its data sheet, and one that is uncalibrated (SensorErrorSizes, all sizes together). A
/// stream uses DeviceUncertainty instead of fit_sensor_errors(), which costs more. rate_stream.md (R102), (R103).
class DeviceUncertainty {
 public:
  /// Weight of the samples' information about the errors. Sample errors are correlated, because errors of the flight
  /// model last longer than a sample. fit_sensor_errors() uses an equal weight.
  static constexpr double kEvidenceWeight = 0.03;

  struct Posterior {
    /// Covariance about the errors for which readings are corrected.
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double unlike = 0.0;  ///< probability that the device does not match its data sheet
  };

  /// Buffers of ask(). The buffers are too large for the small stack of a robot's thread.
  struct Work {
    SensorErrors::Matrix system, about_corrected;
  };

  /// `uncalibrated`: prior probability of an uncalibrated device.
  DeviceUncertainty(const SensorErrorSizes& sizes, double uncalibrated);

  /// Computes `posterior` from the measurement information. O(1): two systems of 29 unknowns; no allocation. For
  /// non-finite information, returns the prior. `unlike`: the device is known not to match its data sheet.
  void update(const SensorErrorEvidence& evidence, Work& work, Posterior& posterior, bool unlike = false) const;

  /// Returns the likelihood ratio of synchronous triads, as the data sheet states, against asynchronous triads.
  /// `delay_s` is a measured delay minus the known delay, with its standard deviation. rate_stream.md (R106).
  double odds_of_sheet(double delay_s, double sigma_s) const;

  /// Returns the additional delay, beyond the one already corrected, that `evidence` implies for a device with any
  /// delay within `reach_s`: rate_stream.md (R107). Returns 0 if the information is indefinite. O(1), no allocation.
  double further_delay_s(const SensorErrorEvidence& evidence, double reach_s) const;

  /// Resets the posterior to the prior.
  void reset(Posterior& posterior) const;

  /// Returns the variance of a delay common to both triads [s^2]. For a device that does not match its data sheet, no
  /// measurement determines this delay.
  double common_delay_s2(const Posterior& posterior) const;

 private:
  SensorErrors::Vector sheet_, unknown_;  ///< standard deviations
  double uncalibrated_;
};

}  // namespace tumble
