// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble::mapping {

/// What is believed of the unknowns at one instant. The two covariances are mapping.md's C and E (section 6).
struct Belief {
  Registration::Estimate mean;  ///< the covariance of its state is the motion's block of `weight`
  /// What weighs the mean against the next sweep: counts a point for less than it tells, so that it bears with
  /// outliers.
  Registration::Matrix weight = Registration::Matrix::Zero();
  /// Covariance of what the mean is thought to be off by: follows the errors through what the weights made of them.
  Registration::Matrix error = Registration::Matrix::Zero();
};

/// Of an IMU that was levelled at rest, in a map that hangs on the lidar: mapping.md (R43), (R44).
Belief belief_at_start(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// Effect, to first order, on the unknowns with their motion taken `t_s` after the start, of the unknowns at the start.
Registration::Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s);

/// F P F^T, which needs 32 KiB of stack for itself: nobody who calls it should hold matrices there. `out` is neither.
void sandwich(const Registration::Matrix& F, const Registration::Matrix& P, Registration::Matrix& out);

/// Of F errors F^T, F of unknowns_at, what has to do with the pose or the mounting; zero where neither has. To the bit
/// what the whole product has there, for a third of it: each pose of a recording asks.
Registration::Matrix pose_and_mounting(const Registration::Matrix& F, const Registration::Matrix& errors);

/// Of the unknowns at the end of the segment, which is at `end_ns`; the trajectory is that of the mean.
void at_end(const Belief& at_start, const SweepTrajectory& trajectory, const Registration::Matrix& end_by_start,
            TimeNs end_ns, Belief& end);

/// Pose errors of the IMU by errors of the mounting, at this attitude of it, while the lidar's pose is certain: K of
/// mapping.md (R43).
Eigen::Matrix<double, 6, 6> pose_by_mounting(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m);

/// The matrix with what can be inverted in the place of variances of 0.
Registration::Matrix invertible(const Registration::Matrix& covariance);

}  // namespace tumble::mapping
