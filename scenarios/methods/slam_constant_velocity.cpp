// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

// No prior worth the name: the registration alone decides, as in the family.
constexpr double kPriorM = 1.0;
constexpr double kPriorRad = 0.5;

/// The last change of pose goes on, in translation and in rotation. Nothing of the IMU is used but the times of its
/// samples, at which poses are told, and the vertical at the start, which the scores need and a lidar does not know.
class ConstantVelocity : public TrajectoryModel {
 public:
  ConstantVelocity(std::span<const ImuSample> samples, const Eigen::Quaterniond& q_WL) : samples_(samples) {
    last_.q_WI = q_WL;
  }

  RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    RigidOdometry::Motion motion;
    motion.start = last_;
    motion.start.time_ns = from_ns;
    motion.samples = steady_motion(samples_, rate_rad_s_, Eigen::Vector3d::Zero(), from_ns, to_ns);
    motion.end_covariance = loose_covariance(kPriorM, kPriorRad);
    from_ns_ = from_ns;
    return motion;
  }

  void learn(const RigidOdometry& odometry, const LidarInertialOdometry::SweepReport&) override {
    const MotionState before = last_;
    last_ = odometry.state();
    const double span_s = seconds(last_.time_ns - from_ns_);
    if (!(span_s > 0.0)) return;
    rate_rad_s_ = so3::log(before.q_WI.conjugate() * last_.q_WI) / span_s;
    last_.v_WI_m_s = (last_.p_WI_m - before.p_WI_m) / span_s;
  }

 private:
  std::span<const ImuSample> samples_;
  MotionState last_;
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
  TimeNs from_ns_ = 0;
};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::lidar;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = start_at_rest(samples, start);
  if (!estimate.status.ok()) return estimate;
  RigidOdometry::Params params = rigid_params(sensors, parameters);
  ConstantVelocity model(samples, start.q_WI * Eigen::Quaterniond(params.T_IL.linear()));
  params.T_IL = Eigen::Isometry3d::Identity();
  run_rigid_chain(sensors, samples, params, model, estimate);
  return estimate;
}

}  // namespace

Method slam_constant_velocity() {
  return rig_slam(
      {.name = "constant_velocity",
       .doc =
           "Lidar alone: the last change of pose goes on, the sweep is deskewed with it once and registered point to "
           "plane as a rigid body. A tumble's rate changes by radians per second from sweep to sweep, which this "
           "cannot know. Not modelled: the adaptive threshold and the point-to-point distance of the original.",
       .source = "the family of KISS-ICP, Vizzo et al., RA-L 2023",
       .parameters = rigid_parameters()},
      run);
}

}  // namespace tumble::scenarios
