// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// `prior_weight_covariance` is the matrix C and `state_error_covariance` is the matrix E of mapping.md, section "Two
/// covariances".
struct StateEstimate {
  Registration::Estimate mean;  ///< mean; the covariance of its state is the motion block of `prior_weight_covariance`
  /// The registration weights its prior with `prior_weight_covariance`. Lidar residuals are correlated, and a heuristic
  /// factor makes `prior_weight_covariance` larger than for independent residuals.
  Registration::Matrix prior_weight_covariance = Registration::Matrix::Zero();
  /// covariance of the actual errors of the state `mean`
  Registration::Matrix state_error_covariance = Registration::Matrix::Zero();
};

/// See mapping.md (R54), (R55).
StateEstimate estimate_at_start(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// Returns the derivative of the unknowns at the time `t_s` with respect to the unknowns at the start of the
/// trajectory, where `t_s` is 0.
Registration::Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s);

/// Computes the propagated covariance F P F^T for the transition matrix F and the covariance P. `out` must be a
/// different matrix than P. The computation needs 32 KiB of stack, so callers should keep matrices on the heap.
void propagate_covariance(const Registration::Matrix& F, const Registration::Matrix& P, Registration::Matrix& out);

/// Propagates the covariance `errors` by the transition matrix F, but returns only the blocks of pose and mounting. The
/// returned blocks are bit-identical to the result of propagate_covariance(), and need a third of the computing time.
Registration::Matrix propagate_pose_and_mounting(const Registration::Matrix& F, const Registration::Matrix& errors);

/// covariance of the errors of position, attitude and velocity in world axes
using MotionErrors = Eigen::Matrix<double, Registration::kMotionSize, Registration::kMotionSize>;

/// Returns only the block of position, attitude and velocity of the covariance propagated by the transition matrix F.
MotionErrors marginal_motion_errors(const Registration::Matrix& F, const Registration::Matrix& errors);

/// Returns the covariance of the velocity in IMU axes, R_IW v_WI_W, including the attitude error.
Eigen::Matrix3d velocity_covariance_I(const MotionState& state, const MotionErrors& errors);

void at_end(const StateEstimate& at_start, const SweepTrajectory& trajectory,
            const Registration::Matrix& end_start_jacobian, TimeNs end_ns, StateEstimate& end);

/// Returns the derivative of the IMU's pose error with respect to the mounting errors, if the lidar pose is exact: K of
/// mapping.md (R54).
Eigen::Matrix<double, 6, 6> pose_mounting_jacobian(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m);

/// Adds a small variance to each unknown, because a covariance with variance 0 for fixed unknowns is not invertible.
Registration::Matrix make_invertible(const Registration::Matrix& covariance);

}  // namespace tumble::mapping
