// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble::mapping {

/// StateEstimate is the estimate of the unknowns at one time. The covariances `weight` and `error` are C and E of
/// mapping.md (section 6).
struct StateEstimate {
  Registration::Estimate mean;  ///< the covariance of its state is the motion block of `weight`
  /// Covariance for weighting the mean against the next sweep. For robustness to outliers, `weight` assumes that points
  /// contain less information than independent points.
  Registration::Matrix weight = Registration::Matrix::Zero();
  /// Covariance of the mean's actual errors, propagated through the gains that `weight` determines.
  Registration::Matrix error = Registration::Matrix::Zero();
};

/// Returns the estimate of an IMU levelled at rest, in a map that the lidar's pose defines, see mapping.md (R54),
/// (R55).
StateEstimate estimate_at_start(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// Returns the derivative of the unknowns, with the motion at `t_s` after the start, by the unknowns at the start.
Registration::Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s);

/// Computes F P F^T into `out`, which must be another matrix than P. The function needs 32 KiB of stack, so callers
/// should not have matrices on the stack.
void propagate_covariance(const Registration::Matrix& F, const Registration::Matrix& P, Registration::Matrix& out);

/// Returns the blocks of the product F errors F^T that involve the pose or the mounting. F is the result of
/// unknowns_at(). All other blocks of the returned matrix are zero. The returned blocks equal the blocks of the full
/// product bit for bit, at a third of the cost. The low cost matters because the function is called for each pose of a
/// recording.
Registration::Matrix propagate_pose_and_mounting(const Registration::Matrix& F, const Registration::Matrix& errors);

/// MotionErrors is the covariance of the errors of position, attitude and velocity in W.
using MotionErrors = Eigen::Matrix<double, Registration::kMotionSize, Registration::kMotionSize>;

/// Returns the block of the product F errors F^T that contains the motion. F is the result of unknowns_at().
MotionErrors motion_errors(const Registration::Matrix& F, const Registration::Matrix& errors);

/// Returns the covariance of the error of the velocity in IMU axes, R_IW v_WI_W. An attitude error rotates the
/// velocity.
Eigen::Matrix3d velocity_covariance_I(const MotionState& state, const MotionErrors& errors);

/// Propagates the estimate to the end of the segment, at `end_ns`. `trajectory` is the motion of the estimate's mean.
void at_end(const StateEstimate& at_start, const SweepTrajectory& trajectory,
            const Registration::Matrix& end_start_jacobian, TimeNs end_ns, StateEstimate& end);

/// Returns the derivative of the IMU's pose error by mounting errors for an exact lidar pose, at the given attitude of
/// the IMU. The derivative is K of mapping.md (R54).
Eigen::Matrix<double, 6, 6> pose_mounting_jacobian(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m);

/// Returns the covariance with variances of 0 replaced by small variances, so that the matrix can be inverted.
Registration::Matrix make_invertible(const Registration::Matrix& covariance);

}  // namespace tumble::mapping
