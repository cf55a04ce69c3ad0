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

/// Adds the factors of one sample, and of one step between samples, to an arrow matrix. Contains only derived
/// coefficients.
class RateModel {
 public:
  /// `period_s`: nominal time between samples. This time determines the noise per sample and the scale of the
  /// acceleration. Throws InvalidParams if a parameter is out of bounds.
  RateModel(const RateModelParams& params, double period_s);

  /// Computes the weight of a sample between flight and contact at the current estimate. `rig_covariance` prevents
  /// errors of the calibration from being mistaken for contact. `widen` >= 1 multiplies the threshold while the rates
  /// are still inaccurate. `jump` is the smaller of the jumps to the neighbours, from jump(); flight has at least one
  /// smooth side.
  void weigh(const RateObservation& observation, const RigConstants& rig, const RigConstants::Matrix& rig_covariance,
             double widen, double jump, RateEstimate& estimate) const;

  /// Returns how far a step between two samples violates the smoothness of flight: squared, normalised, six degrees of
  /// freedom.
  double jump(const RateKnot& from, const RateKnot& to, double dt_s) const;

  /// Moves the unmeasured rates of a sample in contact to the minimum of its force, if this minimum is far below the
  /// force at the current estimate. Reason: between two impacts a body may fly for a single sample, which local steps
  /// do not find.
  void seek_flight(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Initialises the bounds of a sample near the current estimate or the reading, whichever is beyond.
  void start_bounds(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Refines the bounds of a sample by expectation propagation (Minka 2001). The Gaussian site gives the marginal the
  /// mean and variance of a truncation at the reading. `damping` in (0, 1] is the weight of the new site.
  void update_bounds(const RateObservation& observation, const RigConstants& rig, const arrow::Conditional& conditional,
                     const RigConstants::Matrix& rig_covariance, double damping, RateEstimate& estimate) const;

  /// Adds gyro, bound, flight and Euler factors of one sample. `doubted` is null or the covariance of the calibration.
  /// If set, the sample does not update the calibration and has a correspondingly reduced weight. Used for flights that
  /// are too short to be distinguished from contact with another calibration.
  void add_sample(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* doubted = nullptr) const;

  /// Adds the effect of SensorErrors on the gradient of a sample, and the sample's evidence about them. A clipped
  /// element provides only its bound, and contact provides nothing; neither contributes evidence. `doubted`: as in
  /// add_sample(); the force of such a sample is left out.
  void add_errors(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::ErrorMatrix& block, arrow::BorderErrors& border, SensorErrorEvidence& evidence,
                  bool doubted = false) const;

  /// Adds the motion prior between two samples, dt_s apart.
  void add_step(const RateEstimate& from, const RateEstimate& to, double dt_s, arrow::Block& block,
                arrow::Block& next) const;

  /// Adds the prior of the calibration.
  void add_rig_prior(const RigConstants& rig, arrow::Corner& corner) const;

  /// Returns the distance of `rig` from its prior. The distance is the Mahalanobis distance divided by the root of the
  /// number of components, and the largest over lever arm, both biases and inertia. About 1 is expected.
  double calibration_mahalanobis(const RigConstants& rig) const;

  RigConstants prior_constants() const { return prior_constants_; }
  const RigConstants::Matrix& prior_covariance() const { return prior_covariance_; }

  /// Converts a step of the solver to physical units.
  Eigen::Matrix<double, 6, 1> unscaled(const arrow::StateVector& step) const;
  /// Converts a difference in physical units to the solver's units.
  arrow::StateVector scaled(const Eigen::Matrix<double, 6, 1>& difference) const;
  /// Returns the reported covariance of a rate: that of the fit, widened in contact, plus the effect of the reading's
  /// time uncertainty.
  Eigen::Matrix3d reported(const Eigen::Matrix3d& covariance_rad2_s2, const RateObservation& observation,
                           const RateEstimate& estimate) const;
  double gyro_sigma_rad_s() const { return gyro_sigma_rad_s_; }
  /// Returns the weight of one sample in errors that last `model_error_s`; 1 for samples of that length or longer.
  double said_once_share() const { return share_; }

 private:
  struct ForceFactor {
    RateFactor factor;
    Eigen::Vector3d information;  ///< of each axis, or element
  };
  /// Converts the flight residual to element directions if an accelerometer element clips, and drops satisfied bounds.
  /// Returns additional variances due to the uncertain rows of the hidden force.
  static Eigen::Vector3d read_accel_elements(const RateObservation& observation, RateFactor& flight);
  ForceFactor force_factor(const RateObservation& observation, const RateEstimate& estimate,
                           const RigConstants& rig) const;
  /// Returns the rate at the time of the gyro's reading, which is earlier by the reading's age.
  RateKnot at_reading(const RateObservation& observation, const RateEstimate& estimate) const;
  /// Returns the gyro's reading corrected for known sensor errors.
  Eigen::Vector3d corrected_rate(const RateObservation& observation, const RateEstimate& estimate) const;
  /// Returns flight_factor() with the known accelerometer errors; `by_delay`: as in late_flight_factor().
  RateFactor flight(const RateObservation& observation, const RateKnot& knot, const RigConstants& rig,
                    Eigen::Vector3d* by_delay = nullptr) const;
  /// Same with only the derivatives by the calibration, which weigh() needs. Costs less than half.
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
  bool exact_ = true;    ///< no sensor errors are known: readings are used unchanged
  double time_scale_s_;  ///< factor from angular acceleration to the solver's unit
  double gyro_sigma_rad_s_;
  double accel_noise_m_s2_;
  double accel_sigma_m_s2_;
  double share_;  ///< weight of one sample in errors that last model_error_s
  RigConstants prior_constants_;
  RigConstants::Matrix prior_covariance_;
  RigConstants::Matrix prior_information_;
};

/// Returns the source of a rate, from its covariance and the standard deviation below which a clipped axis is
/// recovered.
RateSource rate_source(const RateObservation& observation, const RateEstimate& estimate,
                       const Eigen::Matrix3d& covariance_rad2_s2, double recovered_sigma_rad_s);

}  // namespace tumble
