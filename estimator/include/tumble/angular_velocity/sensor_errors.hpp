// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// What a device makes of the motion besides bias and noise, the same for a run: 29 numbers, in this order, matrices
/// row by row.
struct SensorErrors {
  static constexpr int kSize = 29, kAccel = 9, kFelt = 18, kDelay = 27, kBlur = 28;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// Scale and misalignment: the gyro reads (1 + gyro) rate + felt force + bias, the accelerometer (1 + accel) force +
  /// bias.
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Zero(), accel = Eigen::Matrix3d::Zero();
  /// What the gyro feels of the specific force [rad/s per m/s^2].
  Eigen::Matrix3d felt_s_m = Eigen::Matrix3d::Zero();
  /// How much later than the gyro the accelerometer says the same instant.
  double accel_delay_s = 0.0;
  /// How much wider its window is: variance of the instants that a reading mixes, less that of the gyro [s^2]; negative
  /// where the gyro's is the wider one.
  double accel_blur_s2 = 0.0;

  Vector vector() const;
  static SensorErrors from(const Vector& values);
  bool operator==(const SensorErrors&) const = default;
};

/// Errors of a device with their covariance.
struct KnownSensorErrors {
  SensorErrors errors;
  SensorErrors::Matrix covariance = SensorErrors::Matrix::Zero();
};

/// Throws InvalidParams on errors beyond 0.2, or on what is no covariance: a negative eigenvalue would pass for perfect
/// knowledge.
void require_known(const KnownSensorErrors& learnt);

/// What is assumed of a device's errors: standard deviations as a data sheet states them, and those of a device that
/// nobody has calibrated. Which of the two a device is, the readings tell (SensorErrorFit); a second deviation that
/// does not exceed the first takes the sheet's word for it. [0, 0.1] each, units as in SensorErrors.
struct SensorErrorSizes {
  /// MTi-300 sheet: non-orthogonality 0.05 deg; the MPU-6050 has 3 % of scale and 2 % across, taken as 3 sigma.
  double gyro = 5e-4, gyro_unknown = 0.01;
  double accel = 5e-4, accel_unknown = 0.01;
  /// 0.003 deg/s/g; 0.1 deg/s/g.
  double felt_s_m = 5.3e-6, felt_unknown_s_m = 1.8e-4;
  /// Filters of both triads at some 400 Hz; windows and filters of their own. The blur goes with the delay's square.
  double delay_s = 1e-4, delay_unknown_s = 5e-3;

  /// Every number of it, stated once.
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

/// Deviations of all errors; `share` from 0, the sheet's, to 1, those of a device that nobody has calibrated. None is
/// 0.
SensorErrors::Vector error_deviations(const SensorErrorSizes& sizes, double share);

/// What a run's readings say of the errors: of the cost, once all else is at its optimum for each value of the errors,
/// half the second derivative's double and minus the first, about `about`.
struct SensorErrorEvidence {
  SensorErrors about;
  SensorErrors::Matrix information = SensorErrors::Matrix::Zero();
  SensorErrors::Vector gradient = SensorErrors::Vector::Zero();
};

/// Leaves `share` of the evidence along what a motion that is as free as its model cannot tell: a scale that all axes
/// of a gyro or of an accelerometer share, and a turn of both triads together. What stands there is the pull of the
/// model's own residuals, which a motion that is scaled down makes smaller, and counts samples. rate_smoother.md
/// (R37a).
void discount_untold(double share, SensorErrorEvidence& evidence);

/// The errors as the readings tell them and what is assumed beforehand allows.
struct SensorErrorFit {
  KnownSensorErrors known;
  double calibrated = 1.0;  ///< probability that scale and misalignment are those of the sheet
  double together = 1.0;    ///< probability that the triads are sampled as alike as the sheet has it
};

/// Bayes over the sizes: for each combination of what sheet and `unknown` leave open (scale and misalignment of both
/// triads, g-sensitivity, sampling; sizes in between too) the Gaussian posterior of the errors and how likely the
/// readings are under it; mean and covariance are those of the mixture. So a device whose readings show errors as a
/// calibrated one has keeps the small doubt in what its readings do not show. O(1): some 30 systems of 29 unknowns.
/// `learnt`: what earlier runs of the device have told, from learnt_evidence(); believed in full.
SensorErrorFit fit_sensor_errors(const SensorErrorEvidence& evidence, const SensorErrorSizes& sizes,
                                 const SensorErrorEvidence& learnt = {});

/// What a run has told of a device, as evidence for the next: its covariance without what was assumed beforehand of a
/// device that nobody has calibrated, which the next run assumes again.
SensorErrorEvidence learnt_evidence(const KnownSensorErrors& learnt, const SensorErrorSizes& sizes);

}  // namespace tumble
