// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kPosesPerSweep = 10;  // for recordings without IMU

// The prior of the velocity is very weak, so registration alone determines the pose, as in published methods with
// constant velocity.
constexpr double kVelocityPriorM = 1.0;
constexpr double kVelocityPriorRad = 0.5;

/// ConstantVelocity predicts that the pose change over the last lidar sweep repeats, in translation and rotation.
/// ConstantVelocity uses the IMU only for the times of the poses and the initial vertical; without an IMU, the start is
/// assumed upright.
class ConstantVelocity : public TrajectoryModel {
 public:
  ConstantVelocity(std::span<const ImuSample> samples, const Eigen::Quaterniond& q_WL) : samples_(samples) {
    last_.q_WI = q_WL;
  }

  baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    baselines::RigidOdometry::Motion motion;
    motion.start = last_;
    motion.start.time_ns = from_ns;
    motion.samples = steady_motion(samples_, rate_rad_s_, Eigen::Vector3d::Zero(), from_ns, to_ns);
    motion.end_covariance = loose_covariance(kVelocityPriorM, kVelocityPriorRad);
    from_ns_ = from_ns;
    return motion;
  }

  void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport&) override {
    const MotionState before = last_;
    last_ = odometry.state();
    const double span_s = seconds(last_.time_ns - from_ns_);
    if (!(span_s > 0.0)) return;
    rate_rad_s_ = so3::logarithm(before.q_WI.conjugate() * last_.q_WI) / span_s;
    last_.v_WI_m_s = (last_.p_WI_m - before.p_WI_m) / span_s;
  }

 private:
  std::span<const ImuSample> samples_;
  MotionState last_;
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
  TimeNs from_ns_ = 0;
};

std::vector<ImuSample> instants(const sim::LidarRecord& lidar) {
  std::vector<ImuSample> out;
  const std::size_t sweeps = bridge::sweep_count(lidar);
  const auto step_to = [&](TimeNs from_ns, TimeNs to_ns) {
    for (int k = 1; k <= kPosesPerSweep; ++k) {
      const TimeNs at_ns = from_ns + (to_ns - from_ns) * k / kPosesPerSweep;
      if (out.empty() || at_ns > out.back().time_ns) out.emplace_back().time_ns = at_ns;
    }
  };
  for (std::size_t k = 0; k + 1 < sweeps; ++k) step_to(lidar.sweep_start_ns[k], lidar.sweep_start_ns[k + 1]);
  if (sweeps > 0) step_to(lidar.sweep_start_ns.back(), lidar.sweep_start_ns.back() + lidar.sweep_period_ns);
  return out;
}

Estimate run_slam_constant_velocity(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::lidar;
  baselines::RigidOdometry::Params params = rigid_params(sensors, parameters);
  std::vector<ImuSample> samples;
  Eigen::Quaterniond q_WL = Eigen::Quaterniond::Identity();
  if (!sensors.imus.empty()) {
    StartAtRest start;
    estimate.status = bridge::primary_imu_samples(sensors, samples);
    if (estimate.status.ok()) estimate.status = start_at_rest(samples, start);
    q_WL = start.q_WI * Eigen::Quaterniond(params.T_IL.linear());
  } else if (!sensors.lidars.empty()) {
    samples = instants(sensors.lidars.front());
    q_WL = Eigen::Quaterniond(sensors.lidars.front().T_BL.linear());
  }
  if (!estimate.status.ok()) return estimate;
  ConstantVelocity model(samples, q_WL);
  params.T_IL = Eigen::Isometry3d::Identity();
  run_rigid_chain(sensors, samples, params, model, estimate);
  return estimate;
}

}  // namespace

Method slam_constant_velocity() {
  return make_method(
      {.name = "constant_velocity",
       .kind = Kind::slam,
       .doc = "Uses the lidar only: predicts the pose with constant velocity, deskews the sweep once, and "
              "registers the sweep point to plane as a rigid body. The rate of a tumble changes too much "
              "between two sweeps for this method. Without point times, the method does not deskew. The "
              "adaptive threshold and the point-to-point distance of KISS-ICP are not modelled.",
       .source = "similar to KISS-ICP, Vizzo et al., RA-L 2023",
       .settings = {&rigid_settings()},
       .robots = {"rig"}},
      run_slam_constant_velocity);
}

}  // namespace tumble::scenarios
