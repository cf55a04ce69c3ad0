// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

/// What is open of a device's errors by evidence that still grows: a mixture of two devices, one as its sheet says and
/// one that nobody has calibrated (SensorErrorSizes, all at once), the form of fit_sensor_errors() that a stream can
/// afford. rate_stream.md (R103), (R104).
class DeviceDoubt {
 public:
  struct Open {
    /// About the errors that readings are corrected for.
    SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
    double unlike = 0.0;  ///< probability of a device that is not as on its sheet
  };

  /// Scratch space of open(), which is no small part of what a thread of a robot has as its stack.
  struct Work {
    SensorErrors::Matrix system, about_corrected;
  };

  /// `uncalibrated`: probability beforehand of a device that nobody has calibrated.
  DeviceDoubt(const SensorErrorSizes& sizes, double uncalibrated);

  /// O(1): two systems of 29 unknowns; no allocation. Of evidence that is no number what was open before all.
  void ask(const SensorErrorEvidence& evidence, Work& work, Open& open) const;

  /// Before all evidence.
  void forget(Open& open) const;

  /// What both triads may be late by in common, which no evidence tells of a device unlike its sheet: variance [s^2].
  double shared_delay_s2(const Open& open) const;

 private:
  SensorErrors::Vector sheet_, unknown_;  ///< deviations
  double uncalibrated_;
};

}  // namespace tumble
