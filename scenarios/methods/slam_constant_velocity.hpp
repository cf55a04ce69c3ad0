// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/baselines/mapping/rigid_odometry.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "tumble/common/types.hpp"

/// Methods that register each sweep as a rigid body differ only in their trajectory model, which predicts the motion
/// within a sweep.
namespace tumble::scenarios {

class TrajectoryModel {
 public:
  virtual ~TrajectoryModel() = default;
  /// Predicts the motion of the IMU from the end of the last sweep, or from the start of the first sweep, to `to_ns`.
  virtual baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) = 0;
  virtual void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport& report) = 0;
};

/// The specific force of a stationary IMU determines roll and pitch (yaw is 0), and the gyro readings determine the
/// gyro bias.
struct StartAtRest {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
};
/// Computes attitude and gyro bias from the first readings of a stationary IMU, over at most one second.
Status start_at_rest(std::span<const ImuSample> samples, StartAtRest& out);

/// Returns one motion sample per IMU averaging window, with constant rate and acceleration (without gravity) in body
/// axes.
std::vector<MotionSample> steady_motion(std::span<const ImuSample> samples, const Eigen::Vector3d& rate_I_rad_s,
                                        const Eigen::Vector3d& force_I_m_s2, TimeNs from_ns, TimeNs to_ns);

Eigen::Matrix<double, 9, 9> loose_covariance(double sigma_m, double sigma_rad);

void run_rigid_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     const baselines::RigidOdometry::Params& params, TrajectoryModel& model, Estimate& estimate);

const Settings<baselines::RigidOdometry::Params>& rigid_settings();
baselines::RigidOdometry::Params rigid_params(const sim::Sensors& sensors, const sim::Values& parameters);

}  // namespace tumble::scenarios
