// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "motion_prior.hpp"
#include "state_estimate.hpp"

namespace tumble::mapping {

/// SweepBoundary is the state at the boundary of two sweeps, with all data that the next sweep needs.
struct SweepBoundary {
  StateEstimate state_estimate;                                                ///< estimate at the boundary
  Registration::Matrix end_start_jacobian = Registration::Matrix::Identity();  ///< derivative by the last sweep's start
  /// Magnitude |s_j| of the saturation deficit's factor at the boundary, on saturated axes. The magnitude is 0 if the
  /// last sweep was not aligned.
  Eigen::Vector3d deficit_factor = Eigen::Vector3d::Zero();
  Eigen::Matrix3d clipped_velocity_m2_s2 =
      Eigen::Matrix3d::Zero();  ///< variance from the accelerometer's saturation, W
  bool constrained = false;     ///< the last sweep was constrained in all directions

  TimeNs time_ns() const { return state_estimate.mean.state.time_ns; }
};

/// MotionWindow is the motion from the boundary to the end of a sweep, measured by the IMU.
struct MotionWindow {
  std::span<const MotionSample> samples;  ///< samples from the boundary on, also beyond the end
  TimeNs end_ns = 0;
  int resting_sweeps = 0;  ///< consecutive sweeps at rest, including the current sweep
};

/// Prediction is the prediction of the next sweep's unknowns.
struct Prediction {
  Registration::Prior prior;
  Registration::Matrix jacobian_boundary =
      Registration::Matrix::Identity();                        ///< derivative by the unknowns at the boundary
  Registration::Matrix noise = Registration::Matrix::Zero();   ///< process noise
  Registration::Matrix errors = Registration::Matrix::Zero();  ///< covariance of the mean's errors

  /// Computes weight and errors from the weight and errors at the boundary, after all other members are set.
  void compose(const StateEstimate& at_boundary);
  /// Sets the velocity to zero and removes its correlations, for a robot that is known to be at rest. Call
  /// zero_velocity_update() before compose().
  void zero_velocity_update(double sigma_m_s);
};

/// Predicts the unknowns of a sweep; `trajectory` is the inertial motion from the state at the boundary.
Prediction predict(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                   const MotionWindow& window, const SweepTrajectory& trajectory, const MotionPrior& known);

/// Predicts zero motion if the IMU is at rest after a tracking failure, which stops the velocity drift.
void predict_rest(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary, Prediction& prediction);

/// Returns whether the prior alone is accurate enough to insert points into the map. The standard deviation of clipped
/// axes has full weight, even if their saturation deficit is estimated.
bool prior_is_certain(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                      const MotionWindow& window, const SweepTrajectory& trajectory);

/// Returns the posterior of a sweep without alignment, which is the prediction.
StateEstimate posterior(const Prediction& prediction);
/// Returns the posterior of an aligned sweep, see mapping.md (R52).
StateEstimate posterior(const Prediction& prediction, const Registration::Result& aligned);

/// Returns the normalised innovation of SweepReport::innovation, see mapping.md (R62).
double innovation(const Prediction& prediction, const Registration::Estimate& aligned);

/// Returns whether a pose agrees with the prediction, within its covariance and within the matching distance. Beyond
/// the matching distance, any nearby surface may match. `innovation` is the normalised innovation of the pose. See
/// mapping.md (R67).
bool is_expected(const LidarInertialOdometry::Params& params, const Prediction& prediction,
                 const Registration::Estimate& aligned, double innovation);

/// Computes the boundary at the end of a sweep with the motion `trajectory`, from the posterior at the start of the
/// sweep. `alignment` may be null.
void boundary_after(const LidarInertialOdometry::Params& params, const StateEstimate& start, const MotionWindow& window,
                    const SweepTrajectory& trajectory, const Registration::Result* alignment, SweepBoundary& boundary);

/// Returns the correlation of the saturation deficit between adjacent knots, see mapping.md (R46).
double knot_correlation(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory);

}  // namespace tumble::mapping
