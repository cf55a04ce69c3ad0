// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/baselines/mapping/rigid_odometry.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "tumble/common/imu.hpp"

/// The seams of the rigid registration methods: a rate method gives Estimate::rates, a trajectory model the motion
/// inside of a sweep, RigidOdometry the registration. Each method file puts its own together.
namespace tumble::scenarios {

/// What a method expects the motion to be, sweep after sweep, and learns from what the registration made of it.
class TrajectoryModel {
 public:
  virtual ~TrajectoryModel() = default;
  /// From the end of the last sweep (at first: the start of this one) to `to_ns`.
  virtual baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) = 0;
  /// After each sweep; `report.verdict` tells whether the state is more than the expectation.
  virtual void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport& report) = 0;
};

/// What the rest at the start tells: the attitude from the specific force, yaw 0, and the gyro's bias.
struct StartAtRest {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
};
/// From the first second at most, as long as the gyro stays below 0.05 rad/s; one sample at least. `too_few` or
/// `degenerate` where that is no attitude.
Status start_at_rest(std::span<const ImuSample> samples, StartAtRest& out);

/// What the methods with the gyro as it says begin with: samples of the first IMU, its rates with the axes named that
/// are at their rail, and the start.
Status raw_start(const sim::Sensors& sensors, std::vector<ImuSample>& samples, std::vector<RateState>& rates,
                 StartAtRest& start);

/// Windows of the IMU that touch (from_ns, to_ns], rates and forces as given, less the bias; each split in `parts`,
/// between whose means rate and force run linearly. The first window reaches back to from_ns at least.
std::vector<MotionSample> imu_motion(std::span<const ImuSample> samples, std::span<const RateState> rates,
                                     const Eigen::Vector3d& bias_rad_s, TimeNs from_ns, TimeNs to_ns, int parts = 1);

/// The same windows with one body rate and one acceleration (body axes; no gravity) throughout.
std::vector<MotionSample> steady_motion(std::span<const ImuSample> samples, const Eigen::Vector3d& rate_I_rad_s,
                                        const Eigen::Vector3d& force_I_m_s2, TimeNs from_ns, TimeNs to_ns);

/// Prior of a registration that trusts its motion model no more than this.
Eigen::Matrix<double, 9, 9> loose_covariance(double sigma_m, double sigma_rad);

/// The chain with a rigid registration. Sweeps that the IMU does not cover are counted, not registered; a covered lidar
/// is a fact of life.
void run_rigid_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     const baselines::RigidOdometry::Params& params, TrajectoryModel& model, Estimate& estimate);

/// Parameters of the rigid methods and what they mean to the library; T_IL is the calibration's.
const Settings<baselines::RigidOdometry::Params>& rigid_settings();
baselines::RigidOdometry::Params rigid_params(const sim::Sensors& sensors, const sim::Values& parameters);

}  // namespace tumble::scenarios
