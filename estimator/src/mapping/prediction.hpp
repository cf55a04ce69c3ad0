// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "motion_prior.hpp"
#include "state_estimate.hpp"

namespace tumble::mapping {

/// SweepBoundary is the state at the boundary between two sweeps, with all data that the next sweep needs.
struct SweepBoundary {
  /// Estimate of the unknowns at the boundary between both sweeps.
  StateEstimate state_estimate;
  /// Derivative of the unknowns at the boundary with respect to the unknowns at the start of the last sweep.
  Registration::Matrix end_start_jacobian = Registration::Matrix::Identity();
  /// Magnitude |s_j| of the saturation deficit's factor at the end of the last sweep, mapping.md (R8). The magnitude is
  /// 0 for unsaturated axes, and if the last sweep was not registered.
  Eigen::Vector3d deficit_factor = Eigen::Vector3d::Zero();
  Eigen::Matrix3d clipped_velocity_m2_s2 =
      Eigen::Matrix3d::Zero();  ///< variance of the velocity due to the accelerometer's saturation, in W
  bool constrained = false;     ///< surfaces constrained the last sweep in all directions

  TimeNs time_ns() const { return state_estimate.mean.state.time_ns; }
};

/// MotionWindow is the motion that the IMU measures from the last sweep to the end of the current sweep.
struct MotionWindow {
  std::span<const MotionSample> samples;  ///< samples since the boundary, including samples after the sweep
  TimeNs end_ns = 0;
  int resting_sweeps = 0;  ///< consecutive sweeps at rest, including the current sweep
};

/// Prediction contains the predicted unknowns of the next sweep.
struct Prediction {
  Registration::Prior prior;
  /// Derivative of the predicted unknowns with respect to the unknowns at the boundary.
  Registration::Matrix jacobian_boundary = Registration::Matrix::Identity();
  Registration::Matrix noise = Registration::Matrix::Zero();   ///< process noise
  Registration::Matrix errors = Registration::Matrix::Zero();  ///< covariance of the actual errors of the mean

  /// Computes the predicted covariances from the covariances at the boundary. Call compose() after setting all other
  /// members.
  void compose(const StateEstimate& at_boundary);
  /// Sets the velocity to zero and removes its correlations, for a robot that is known to be at rest. Call
  /// zero_velocity_update() before compose().
  void zero_velocity_update(double sigma_m_s);
};

/// Predicts the unknowns of a sweep. `trajectory` is the inertial motion since the end of the last sweep.
Prediction predict(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                   const MotionWindow& window, const SweepTrajectory& trajectory, const MotionPrior& known);

/// Predicts zero motion if the IMU is at rest after a tracking failure, which stops the drift of the velocity.
void predict_rest(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary, Prediction& prediction);

/// Returns whether the prior alone is accurate enough to insert points into the map. For clipped axes, the full
/// reported standard deviation of the rate counts.
bool prior_is_certain(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                      const MotionWindow& window, const SweepTrajectory& trajectory);

/// Returns the estimate for a sweep without registration: the prediction.
StateEstimate posterior(const Prediction& prediction);
/// Returns the estimate after the registration of a sweep, see mapping.md (R52).
StateEstimate posterior(const Prediction& prediction, const Registration::Result& aligned);

/// Returns the normalised difference between registered and predicted motion (SweepReport::innovation), see mapping.md
/// (R62).
double innovation(const Prediction& prediction, const Registration::Estimate& aligned);

/// Returns whether a registered pose agrees with the prediction, see mapping.md (R67). The difference must be within
/// the predicted covariance and the matching distance. Beyond the matching distance, any nearby surface may match by
/// chance. `innovation` is the normalised innovation of the pose.
bool is_expected(const LidarInertialOdometry::Params& params, const Prediction& prediction,
                 const Registration::Estimate& aligned, double innovation);

/// Computes the SweepBoundary at the end of a sweep from the estimate at its start and the motion `trajectory`.
/// `alignment` is null for a sweep without registration.
void boundary_after(const LidarInertialOdometry::Params& params, const StateEstimate& start, const MotionWindow& window,
                    const SweepTrajectory& trajectory, const Registration::Result* alignment, SweepBoundary& boundary);

/// Returns the correlation of the saturation deficit between adjacent knots of a sweep, see mapping.md (R46).
double knot_correlation(const SweepTrajectory& trajectory);

}  // namespace tumble::mapping
