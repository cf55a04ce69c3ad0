// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/rate_factors.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rig_constants.hpp"

namespace tumble {

/// Adds the measurements of samples and the motion between samples to the normal equations of RateSmoother and
/// RateStream.
class RateModel {
 public:
  /// `period_s` is the nominal time between samples, which determines the noise per sample.
  RateModel(const RateModelParams& params, double period_s);

  /// Computes the weight of a sample between contact (0) and free flight (1) at the current estimate. `rig_covariance`,
  /// the covariance of the calibration, prevents that calibration errors are mistaken for contact. `threshold_factor`
  /// >= 1 multiplies the contact threshold while the rates are still inaccurate. `jump` is the smaller result of jump()
  /// between the sample and its two neighbours.
  void compute_flight_weight(const RateObservation& observation, const RigConstants& rig,
                             const RigConstants::Matrix& rig_covariance, double threshold_factor, double jump,
                             RateEstimate& estimate) const;

  /// Returns the squared normalised deviation from constant angular acceleration between two samples (chi-square
  /// distribution with six degrees of freedom).
  double jump(const RateKnot& from, const RateKnot& to, double dt_s) const;

  /// Moves the unmeasured rates of a sample in contact to the minimum of the contact force, if this minimum is far
  /// below the current contact force.
  void search_flight(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  void start_bounds(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Refines the lower bounds of a sample's clipped rates by expectation propagation (Minka 2001). `damping` in (0, 1]
  /// is the weight of the new bound.
  void update_bounds(const RateObservation& observation, const RigConstants& rig, const arrow::Conditional& conditional,
                     const RigConstants::Matrix& rig_covariance, double damping, RateEstimate& estimate) const;

  /// `rig_spread` is null, or the covariance of the calibration. If a covariance is passed, the sample has a reduced
  /// weight and does not update the calibration. Pass a covariance for short flights, because a different calibration
  /// could explain the same readings as contact.
  void add_sample(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* rig_spread = nullptr) const;

  /// Adds the derivatives of a sample's gradient with respect to the sensor errors, and the sample's information about
  /// these errors. Clipped elements and samples in contact contribute no information about SensorErrors.
  void add_errors(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::ErrorMatrix& block, arrow::BorderErrors& border, SensorErrorEvidence& evidence,
                  bool rig_spread = false) const;

  void add_step(const RateEstimate& from, const RateEstimate& to, double dt_s, arrow::Block& block,
                arrow::Block& next) const;

  void add_rig_prior(const RigConstants& rig, arrow::Corner& corner) const;

  /// Returns the largest distance of lever arm, gyro bias, accelerometer bias and inertia from their prior, in standard
  /// deviations.
  double calibration_mahalanobis(const RigConstants& rig) const;

  RigConstants prior_constants() const { return prior_constants_; }
  const RigConstants::Matrix& prior_covariance() const { return prior_covariance_; }

  Eigen::Matrix<double, 6, 1> unscaled(const arrow::StateVector& step) const;
  arrow::StateVector scaled(const Eigen::Matrix<double, 6, 1>& difference) const;
  /// Returns the covariance to report, which includes the uncertain time of the reading. In contact, the reported
  /// covariance is larger than the least-squares covariance `covariance_rad2_s2`.
  Eigen::Matrix3d reported(const Eigen::Matrix3d& covariance_rad2_s2, const RateObservation& observation,
                           const RateEstimate& estimate) const;
  double gyro_sigma_rad_s() const { return gyro_sigma_rad_s_; }
  /// Returns period_s / model_error_s, at most 1: the weight of one sample, because close samples have equal model
  /// errors.
  double independent_reading_ratio() const { return share_; }

 private:
  struct ForceFactor {
    RateFactor factor;
    Eigen::Vector3d information;  ///< information (inverse variance) of each axis or element
  };
  /// Converts the flight residual to element directions if an accelerometer element clips. Returns variances from
  /// uncertain sensing directions and from the saturation deficit of the specific force.
  static Eigen::Vector3d read_accel_elements(const RateObservation& observation, RateFactor& flight);
  ForceFactor force_factor(const RateObservation& observation, const RateEstimate& estimate,
                           const RigConstants& rig) const;
  RateKnot knot_at_reading(const RateObservation& observation, const RateEstimate& estimate) const;
  Eigen::Vector3d corrected_rate(const RateObservation& observation, const RateEstimate& estimate) const;
  RateFactor flight(const RateObservation& observation, const RateKnot& knot, const RigConstants& rig,
                    Eigen::Vector3d* jacobian_delay = nullptr) const;
  RateFactor flight_jacobian_calibration(const RateObservation& observation, const RateKnot& knot,
                                         const RigConstants& rig) const;
  double gyro_information(const RateObservation& observation, const RateEstimate& estimate, int axis) const;
  void add_gyro(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                arrow::Block& block, arrow::Corner& corner) const;
  void add_elements(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                    arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* rig_spread) const;
  static bool is_uninformative(const RateEstimate& estimate);
  static void exclude_from_calibration(const RateObservation& observation, RateFactor& flight);
  void add_auxiliary_imus(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                          arrow::Block& block) const;
  Eigen::Matrix3d euler_information(const RateEstimate& estimate) const;
  double accel_sigma_m_s2(const RateObservation& observation) const;
  double accel_variance_of_sum(const RateObservation& observation) const;

  RateModelParams params_;
  bool uses_raw_readings_ = true;  ///< readings are used unchanged, because no sensor errors are known
  double time_scale_s_;            ///< factor from angular acceleration to the solver's unit
  double gyro_sigma_rad_s_;
  double accel_noise_m_s2_;
  double accel_sigma_m_s2_;
  double share_;  ///< result of independent_reading_ratio()
  RigConstants prior_constants_;
  RigConstants::Matrix prior_covariance_;
  RigConstants::Matrix prior_information_;
};

/// In contact, a clipped axis counts as recovered if its standard deviation is at most `recovered_sigma_rad_s`.
RateSource rate_source(const RateObservation& observation, const RateEstimate& estimate,
                       const Eigen::Matrix3d& covariance_rad2_s2, double recovered_sigma_rad_s);

}  // namespace tumble
