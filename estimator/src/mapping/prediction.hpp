// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "motion_prior.hpp"
#include "state_estimate.hpp"

namespace tumble::mapping {

/// State at the boundary of two sweeps: everything that the next sweep needs.
struct SweepBoundary {
  StateEstimate state_estimate;                                          ///< at the boundary
  Registration::Matrix end_by_start = Registration::Matrix::Identity();  ///< derivative by the last start
  /// Magnitude |s_j| of the saturation deficit's factor at the boundary, on saturated axes. The factor is 0 if the last
  /// sweep was not aligned.
  Eigen::Vector3d deficit_share = Eigen::Vector3d::Zero();
  Eigen::Matrix3d railed_velocity_m2_s2 = Eigen::Matrix3d::Zero();  ///< variance from the last sweep's saturation, W
  bool constrained = false;  ///< the last sweep was constrained in all directions

  TimeNs time_ns() const { return state_estimate.mean.state.time_ns; }
};

/// Motion from the boundary to a sweep's end, measured by the IMU.
struct MotionWindow {
  std::span<const MotionSample> samples;  ///< from the boundary on, also beyond the end
  TimeNs end_ns = 0;
  int resting_sweeps = 0;  ///< consecutive sweeps at rest by the IMU, including this one
};

/// Prediction of the next sweep's unknowns.
struct Prediction {
  Registration::Prior prior;
  Registration::Matrix by_last = Registration::Matrix::Identity();  ///< derivative by the unknowns at the boundary
  Registration::Matrix noise = Registration::Matrix::Zero();        ///< process noise
  Registration::Matrix errors = Registration::Matrix::Zero();       ///< covariance of the mean's errors, as reported

  /// Computes weight and errors from the weight and errors at the boundary, after all other members are set.
  void compose(const StateEstimate& at_boundary);
  /// Sets the velocity to zero and decorrelates the velocity, for a robot known to be at rest. Call before compose().
  void zero_velocity_update(double sigma_m_s);
};

/// Predicts the unknowns of a sweep; `trajectory` is the inertial motion from the boundary's state.
Prediction predict(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                   const MotionWindow& window, const SweepTrajectory& trajectory, const MotionPrior& known);

/// Predicts no motion after tracking failure with the IMU at rest, which stops the velocity drift.
void predict_rest(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary, Prediction& prediction);

/// Returns whether the prior alone is accurate enough to insert points. Clipped axes have full weight, even if their
/// saturation deficit is estimated.
bool prior_is_certain(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                      const MotionWindow& window, const SweepTrajectory& trajectory);

/// Returns the posterior of a sweep without alignment, which is the prediction.
StateEstimate posterior(const Prediction& prediction);
/// Returns the posterior of an aligned sweep: mapping.md (R52).
StateEstimate posterior(const Prediction& prediction, const Registration::Result& aligned);

/// See SweepReport::innovation; mapping.md (R62).
double innovation(const Prediction& prediction, const Registration::Estimate& aligned);

/// Returns whether a pose agrees with the prediction: within its covariance and within the matching distance, beyond
/// which any nearby surface may match. `innovation` is the normalised innovation of the pose. mapping.md (R67).
bool is_expected(const LidarInertialOdometry::Params& params, const Prediction& prediction,
                 const Registration::Estimate& aligned, double innovation);

/// Computes the boundary at the end of a sweep with the motion `trajectory`, from the posterior at the sweep's start.
/// `alignment` may be null.
void boundary_after(const LidarInertialOdometry::Params& params, const StateEstimate& start, const MotionWindow& window,
                    const SweepTrajectory& trajectory, const Registration::Result* alignment, SweepBoundary& boundary);

/// Returns the correlation of the saturation deficit between adjacent knots: mapping.md (R46).
double knot_correlation(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory);

}  // namespace tumble::mapping
