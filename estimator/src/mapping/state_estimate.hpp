// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// The covariances `prior_weight_covariance` and `state_error_covariance` are C and E of mapping.md, "Two covariances".
struct StateEstimate {
  Registration::Estimate mean;  ///< mean; the covariance of its state is the motion block of `prior_weight_covariance`
  /// For robustness, `prior_weight_covariance` assigns less information to the points than independent points would
  /// have.
  Registration::Matrix prior_weight_covariance = Registration::Matrix::Zero();
  /// covariance of the errors of `mean`
  Registration::Matrix state_error_covariance = Registration::Matrix::Zero();
};

/// See mapping.md (R54), (R55).
StateEstimate estimate_at_start(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// Returns the derivative of the unknowns `t_s` after the start of a trajectory with respect to the unknowns at its
/// start.
Registration::Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s);

/// Computes F P F^T into `out`, which must not be P. propagate_covariance() needs 32 KiB of stack, so callers should
/// keep matrices on the heap.
void propagate_covariance(const Registration::Matrix& F, const Registration::Matrix& P, Registration::Matrix& out);

/// Returns the blocks of pose and mounting of the covariance `errors`, propagated by the transition matrix F. The
/// returned blocks are bit-identical to the blocks from propagate_covariance(), at a third of the computing time.
Registration::Matrix propagate_pose_and_mounting(const Registration::Matrix& F, const Registration::Matrix& errors);

/// covariance of the errors of position, attitude and velocity in frame W
using MotionErrors = Eigen::Matrix<double, Registration::kMotionSize, Registration::kMotionSize>;

/// Returns the block of position, attitude and velocity of `errors`, propagated by the transition matrix F.
MotionErrors marginal_motion_errors(const Registration::Matrix& F, const Registration::Matrix& errors);

/// Returns the covariance of the velocity in IMU axes, R_IW v_WI_W, including the attitude error.
Eigen::Matrix3d velocity_covariance_I(const MotionState& state, const MotionErrors& errors);

void at_end(const StateEstimate& at_start, const SweepTrajectory& trajectory,
            const Registration::Matrix& end_start_jacobian, TimeNs end_ns, StateEstimate& end);

/// Returns the derivative of the IMU's pose error with respect to mounting errors for an exact lidar pose: K of
/// mapping.md (R54).
Eigen::Matrix<double, 6, 6> pose_mounting_jacobian(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m);

/// Small variances replace zeros.
Registration::Matrix make_invertible(const Registration::Matrix& covariance);

}  // namespace tumble::mapping
