// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/rate_factors.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rig_constants.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

/// The factors of one sample and of one step between samples, added to an arrow matrix. Holds derived coefficients
/// only.
class RateModel {
 public:
  /// `period_s`: nominal time between samples, from which noise per sample and the scale of the acceleration follow.
  /// Throws InvalidParams on a parameter outside of its bound.
  RateModel(const RateModelParams& params, double period_s);

  /// Weighs a sample between flight and contact at the current estimate. `rig_covariance`: what is not yet known of
  /// the rig must not pass for contact. `widen` >= 1 multiplies the threshold while the rates themselves are unknown.
  /// `jump`: the smaller of the jumps to the neighbours, from jump(); flight has at least one smooth side.
  void weigh(const RateObservation& observation, const RigConstants& rig, const RigConstants::Matrix& rig_covariance,
             double widen, double jump, RateEstimate& estimate) const;

  /// How far a step between two samples is from the smoothness of flight: squared, normalised, six degrees of freedom.
  double jump(const RateKnot& from, const RateKnot& to, double dt_s) const;

  /// Moves the unseen rates of a sample in contact to where its force is smallest, when that is far smaller than at the
  /// current estimate: between two impacts a body may fly for a single sample, which no local step finds.
  void seek_flight(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Starts the bounds of a sample: near the current estimate or the reading, whichever lies beyond.
  void start_bounds(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Refines the bounds of a sample by expectation propagation (Minka 2001): the Gaussian site with which the marginal
  /// has the mean and variance that truncation at the reading gives it. `damping` in (0, 1] is the share of the new.
  void update_bounds(const RateObservation& observation, const RigConstants& rig, const arrow::Conditional& conditional,
                     const RigConstants::Matrix& rig_covariance, double damping, RateEstimate& estimate) const;

  /// Adds gyro, bound, flight and Euler factors of one sample. `doubted`: null, or what is not known of the rig, where
  /// the sample shall say nothing of the rig and count for as little as that leaves it (a flight too short to be told
  /// from contact of another rig).
  void add_sample(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* doubted = nullptr) const;

  /// What each of SensorErrors does to the gradient of a sample, and what the sample says of them. A clipped element
  /// says no more than where its rail is, contact nothing: neither tells of errors. `doubted`: of a sample that
  /// add_sample() has let say nothing of the rig; its force is left out.
  void add_errors(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::ErrorMatrix& block, arrow::BorderErrors& border, SensorErrorEvidence& evidence,
                  bool doubted = false) const;

  /// Adds the motion prior between two samples, dt_s apart.
  void add_step(const RateEstimate& from, const RateEstimate& to, double dt_s, arrow::Block& block,
                arrow::Block& next) const;

  /// Adds what was known of the rig beforehand.
  void add_rig_prior(const RigConstants& rig, arrow::Corner& corner) const;

  /// How far `rig` is from what was known beforehand: the largest, over lever arm, both biases and inertia, of the
  /// Mahalanobis distance divided by the root of the number of components. About 1 is expected.
  double calibration_mahalanobis(const RigConstants& rig) const;

  RigConstants prior_constants() const { return prior_constants_; }
  const RigConstants::Matrix& prior_covariance() const { return prior_covariance_; }

  /// A step of the solver in physical units.
  Eigen::Matrix<double, 6, 1> unscaled(const arrow::StateVector& step) const;
  /// A difference in physical units in those of the solver.
  arrow::StateVector scaled(const Eigen::Matrix<double, 6, 1>& difference) const;
  /// Covariance of a rate as it is reported: of the fit, wider in contact, and what the time of a reading leaves open.
  Eigen::Matrix3d reported(const Eigen::Matrix3d& covariance_rad2_s2, const RateObservation& observation,
                           const RateEstimate& estimate) const;
  double gyro_sigma_rad_s() const { return gyro_sigma_rad_s_; }
  /// Of what lasts `model_error_s`, what one sample may say; 1 for samples as long as that.
  double said_once_share() const { return share_; }

 private:
  struct ForceFactor {
    RateFactor factor;
    Eigen::Vector3d information;  ///< of each axis, or element
  };
  /// The residual of flight element by element where one of the accelerometer's clips: bounds that hold are dropped.
  /// Returns variances to be added, of what unknown rows make of the hidden force.
  static Eigen::Vector3d read_accel_elements(const RateObservation& observation, RateFactor& flight);
  ForceFactor force_factor(const RateObservation& observation, const RateEstimate& estimate,
                           const RigConstants& rig) const;
  /// The rate of which the gyro's reading tells: earlier by the reading's age.
  RateKnot at_reading(const RateObservation& observation, const RateEstimate& estimate) const;
  /// The gyro's reading without what the device is known to make of the motion.
  Eigen::Vector3d corrected_rate(const RateObservation& observation, const RateEstimate& estimate) const;
  /// flight_factor() with what is known of the accelerometer's errors; `by_delay`: as late_flight_factor().
  RateFactor flight(const RateObservation& observation, const RateKnot& knot, const RigConstants& rig,
                    Eigen::Vector3d* by_delay = nullptr) const;
  /// The same with the derivatives that weigh() needs, by the rig: in place of all of them less than half the work.
  RateFactor flight_by_rig(const RateObservation& observation, const RateKnot& knot, const RigConstants& rig) const;
  double gyro_information(const RateObservation& observation, const RateEstimate& estimate, int axis) const;
  void add_gyro(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                arrow::Block& block, arrow::Corner& corner) const;
  void add_elements(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                    arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* doubted) const;
  static bool says_nothing_of_rig(const RateEstimate& estimate);
  static void keep_from_rig(const RateObservation& observation, RateFactor& flight);
  void add_auxiliary_imus(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                          arrow::Block& block) const;
  Eigen::Matrix3d euler_information(const RateEstimate& estimate) const;
  double accel_sigma_m_s2(const RateObservation& observation) const;
  double accel_variance_together(const RateObservation& observation) const;

  RateModelParams params_;
  bool exact_ = true;    ///< nothing is known of errors: readings are taken as they are
  double time_scale_s_;  ///< the solver's acceleration is the acceleration times this
  double gyro_sigma_rad_s_;
  double accel_noise_m_s2_;
  double accel_sigma_m_s2_;
  double share_;  ///< of what lasts model_error_s, that one sample may say
  RigConstants prior_constants_;
  RigConstants::Matrix prior_covariance_;
  RigConstants::Matrix prior_information_;
};

/// Where a rate comes from, given its covariance and the deviation below which a clipped axis counts as recovered.
RateSource rate_source(const RateObservation& observation, const RateEstimate& estimate,
                       const Eigen::Matrix3d& covariance_rad2_s2, double recovered_sigma_rad_s);

}  // namespace tumble
