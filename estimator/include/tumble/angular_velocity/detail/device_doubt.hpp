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
  /// Samples err in common (what the model of flight misses lasts longer than one of them): the share that is believed
  /// of what they say of where the errors lie, as in fit_sensor_errors().
  static constexpr double kBelieved = 0.03;

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
  /// `unlike`: the device is known to be none that is as its sheet says.
  void ask(const SensorErrorEvidence& evidence, Work& work, Open& open, bool unlike = false) const;

  /// How likely triads are that are sampled as alike as the sheet has it against such that are not, by a delay that
  /// was measured, with its deviation, less what is given. rate_stream.md (R109).
  double odds_of_sheet(double delay_s, double sigma_s) const;

  /// The delay by `evidence` about the errors that are corrected for, this among them, of a device that may have any
  /// within `reach_s`: rate_stream.md (R110), less what is corrected for. 0 where the evidence is indefinite. O(1), no
  /// allocation.
  double further_delay_s(const SensorErrorEvidence& evidence, double reach_s) const;

  /// Before all evidence.
  void forget(Open& open) const;

  /// What both triads may be late by in common, which no evidence tells of a device unlike its sheet: variance [s^2].
  double shared_delay_s2(const Open& open) const;

 private:
  SensorErrors::Vector sheet_, unknown_;  ///< deviations
  double uncalibrated_;
};

}  // namespace tumble
