// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/types.hpp"

namespace tumble {

/// Adds sensor readings and the motion model between samples to the normal equations of AngularRateSmoother and
/// AngularRateStream.
class AngularRateModel {
 public:
  /// `period_s` is the nominal time between samples, which determines the noise per sample.
  AngularRateModel(const AngularRateModelParams& params, double period_s);

  /// Computes a weight between 0 (contact) and 1 (free flight) for a sample, from the residuals of specific force and
  /// Euler's equation. The covariance `rig_covariance` of the rig constants prevents that their errors look like
  /// contact. `threshold_factor` >= 1 multiplies the contact threshold while the rates are still inaccurate. `jump` is
  /// the smaller result of jump() between the sample and its two neighbours.
  void compute_flight_weight(const AngularRateObservation& observation, const BodyImuConstants& rig,
                             const BodyImuConstants::Matrix& rig_covariance, double threshold_factor, double jump,
                             AngularRateEstimate& estimate) const;

  /// Returns the squared normalised deviation from constant angular acceleration between two samples (chi-square
  /// distribution with six degrees of freedom).
  double jump(const AngularRateKnot& from, const AngularRateKnot& to, double dt_s) const;

  /// For a sample in contact, changes the rates on saturated axes to those with minimum contact force, if the minimum
  /// is far below the current contact force.
  void search_flight_solutions(const AngularRateObservation& observation, const BodyImuConstants& rig,
                               AngularRateEstimate& estimate) const;

  void initialise_rate_bounds(const AngularRateObservation& observation, const BodyImuConstants& rig,
                              AngularRateEstimate& estimate) const;

  /// Refines the Gaussian approximation of the lower bounds on clipped rates by expectation propagation (Minka 2001).
  /// `damping` in (0, 1] is the weight of the new approximation.
  void update_bounds(const AngularRateObservation& observation, const BodyImuConstants& rig,
                     const arrow::Conditional& conditional, const BodyImuConstants::Matrix& rig_covariance,
                     double damping, AngularRateEstimate& estimate) const;

  /// Adds the residuals of one sample. `rig_spread` is null, or the covariance of the rig constants for a sample of a
  /// short flight. With `rig_spread`, the sample has a lower weight and does not update the rig constants. Errors of
  /// the rig constants could otherwise make contact look like a short flight.
  void add_sample(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                  const BodyImuConstants& rig, arrow::Block& block, arrow::Corner& corner,
                  const BodyImuConstants::Matrix* rig_spread = nullptr) const;

  /// Adds a sample's information about SensorErrors, and the derivatives of the sample's gradient with respect to
  /// SensorErrors. Clipped sensing elements and samples in contact contribute nothing.
  void add_sensor_errors(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                         const BodyImuConstants& rig, arrow::ErrorMatrix& block, arrow::BorderErrors& border,
                         SensorErrorInformation& evidence, bool rig_spread = false) const;

  void add_motion_model(const AngularRateEstimate& from, const AngularRateEstimate& to, double dt_s,
                        arrow::Block& block, arrow::Block& next) const;

  void add_rig_prior(const BodyImuConstants& rig, arrow::Corner& corner) const;

  /// Returns the largest distance of lever arm, gyro bias, accelerometer bias and inertia from their priors, in prior
  /// standard deviations.
  double calibration_mahalanobis(const BodyImuConstants& rig) const;
  /// Returns the same distance, but the standard deviations include the effect of the sensor errors on the estimated
  /// constants. `error_jacobian` is the derivative of the constants with respect to the sensor errors.
  /// `error_covariance` is the covariance of the sensor errors.
  double calibration_mahalanobis(const BodyImuConstants& rig, const arrow::BorderErrors& error_jacobian,
                                 const SensorErrors::Matrix& error_covariance) const;

  BodyImuConstants prior_constants() const { return prior_constants_; }
  const BodyImuConstants::Matrix& prior_covariance() const { return prior_covariance_; }

  Eigen::Matrix<double, 6, 1> unscaled_step(const arrow::StateVector& step) const;
  arrow::StateVector scaled_difference(const Eigen::Matrix<double, 6, 1>& difference) const;
  /// Returns the covariance of the rate to report: the least-squares covariance plus the effect of the uncertain time
  /// of the gyro reading. In contact, the covariance is increased further.
  Eigen::Matrix3d output_covariance(const Eigen::Matrix3d& covariance_rad2_s2,
                                    const AngularRateObservation& observation,
                                    const AngularRateEstimate& estimate) const;
  double gyro_sigma_rad_s() const { return gyro_sigma_rad_s_; }
  /// Returns period_s / model_error_s, at most 1: the weight of the information of one sample. Close samples have equal
  /// errors of the motion model.
  double independent_sample_fraction() const { return independent_sample_fraction_; }

 private:
  struct ForceFactor {
    AngularRateFactor factor;
    Eigen::Vector3d information;
  };
  /// If an accelerometer element clips, converts the residual of the specific force to the directions of the sensing
  /// elements. Returns the variances that result from uncertain sensing directions and from the saturation deficit.
  static Eigen::Vector3d accel_sensing_axis_readings(const AngularRateObservation& observation,
                                                     AngularRateFactor& flight);
  ForceFactor force_factor(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                           const BodyImuConstants& rig) const;
  AngularRateKnot knot_at_reading(const AngularRateObservation& observation, const AngularRateEstimate& estimate) const;
  Eigen::Vector3d corrected_rate(const AngularRateObservation& observation, const AngularRateEstimate& estimate) const;
  AngularRateFactor flight(const AngularRateObservation& observation, const AngularRateKnot& knot,
                           const BodyImuConstants& rig, Eigen::Vector3d* jacobian_delay = nullptr) const;
  AngularRateFactor flight_force_calibration_jacobian(const AngularRateObservation& observation,
                                                      const AngularRateKnot& knot, const BodyImuConstants& rig) const;
  double gyro_information(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                          int axis) const;
  void add_gyro(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                const BodyImuConstants& rig, arrow::Block& block, arrow::Corner& corner) const;
  void add_sensing_axis_readings(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                                 const BodyImuConstants& rig, arrow::Block& block, arrow::Corner& corner,
                                 const BodyImuConstants::Matrix* rig_spread) const;
  static bool has_no_error_information(const AngularRateEstimate& estimate);
  static void exclude_from_calibration(const AngularRateObservation& observation, AngularRateFactor& flight);
  void add_auxiliary_imus(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                          const BodyImuConstants& rig, arrow::Block& block) const;
  Eigen::Matrix3d euler_equation_information(const AngularRateEstimate& estimate) const;
  double accel_sigma_m_s2(const AngularRateObservation& observation) const;
  double total_accel_variance(const AngularRateObservation& observation) const;

  AngularRateModelParams params_;
  bool uses_raw_readings_ = true;  ///< no sensor errors are known, so the readings need no correction
  double time_scale_s_;            ///< the solver uses angular acceleration times this factor
  double gyro_sigma_rad_s_;
  double accel_noise_m_s2_;
  double accel_sigma_m_s2_;
  double independent_sample_fraction_;
  BodyImuConstants prior_constants_;
  BodyImuConstants::Matrix prior_covariance_;
  BodyImuConstants::Matrix prior_information_;
};

/// In contact, a clipped axis counts as recovered if its standard deviation is at most 0.5 rad/s.
AngularRateSource rate_source_of(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                                 const Eigen::Matrix3d& covariance_rad2_s2);

}  // namespace tumble
