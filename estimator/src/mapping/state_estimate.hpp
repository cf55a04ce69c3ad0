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

/// WorldCovariance is the covariance of the map relative to the world frame, which the first pose of the IMU defines.
/// The covariance of the map includes errors of mounting, initial tilt, scale and inserted sweeps, and drift in
/// unconstrained directions.
class WorldCovariance {
 public:
  using Pose = Eigen::Matrix<double, 6, 6>;

  WorldCovariance() = default;
  WorldCovariance(const WorldCovarianceParams& params, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m,
                  const Eigen::Vector3d& p_WI_m = Eigen::Vector3d::Zero())
      : params_(params),
        first_position_W_m_(p_WI_m),
        last_map_extension_W_m_(p_WI_m),
        mounting_jacobian_at_start_(pose_mounting_jacobian(q_WI, p_IL_m)) {}

  /// Returns the covariance after localisation in a prior map. The prior map is assumed exact.
  static WorldCovariance covariance_in_prior_map(const WorldCovarianceParams& params, const Eigen::Vector3d& p_WI_m);

  /// Returns the covariance of the IMU pose in the world frame, at the IMU position `p_WI_m`. `joint` is the covariance
  /// of the registration's unknowns relative to the map.
  Pose in_world_frame(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// Returns the standard deviation of the IMU's position relative to the nearby part of the map.
  double sigma_in_map_m(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const;

  /// `least_constrained_direction` is the direction of motion (position, scaled attitude) that the surfaces around the
  /// sensor constrain least.
  void add_drift(double least_constrained_sigma_m, const Eigen::Matrix<double, 6, 1>& least_constrained_direction);
  /// `inserted_fraction` is the fraction of the sweep's points that were inserted into the map. `errors` is the
  /// covariance of the registration's unknowns at the start of the sweep.
  void add_inserted_sweep(double inserted_fraction, const SweepTrajectory& trajectory,
                          const Registration::Matrix& errors, const Eigen::Vector3d& p_IL_m);

  double tilt_sigma_rad() const { return params_.tilt_sigma_rad; }

 private:
  Pose mounting_jacobian_at_start(const Eigen::Vector3d& p_WI_m) const;

  WorldCovarianceParams params_;
  Eigen::Vector3d first_position_W_m_ = Eigen::Vector3d::Zero();  // position of the first pose of the IMU
  Eigen::Vector3d last_map_extension_W_m_ =
      Eigen::Vector3d::Zero();  // position of the sweep that extended the map last
  Pose mounting_jacobian_at_start_ = Pose::Zero();
  Pose map_ = Pose::Zero();  // covariance of the map relative to the world, at last_map_extension_W_m_
  Eigen::Matrix3d drift_covariance_m2_ = Eigen::Matrix3d::Zero();  // covariance of the position drift
};

}  // namespace tumble::mapping
