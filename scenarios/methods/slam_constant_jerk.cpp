// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

// Observer gains per second from the authors' settings (Chen et al., section IV-D).
constexpr double kGainPosition = 4.5;
constexpr double kGainVelocity = 11.25;
constexpr double kGainAttitude = 4.0;
constexpr double kGainGyroBias = 1.0;
constexpr double kGainAccelBias = 2.25;
constexpr double kBiasMax = 0.5;   // bound of both biases, as in the authors' code
constexpr double kSpanMaxS = 0.2;  // longest correction step: gains suit sweeps, not gaps
constexpr int kPartsOfSample = 4;  // subdivisions of a sample; rate and force are linear between them
constexpr double kJerkPriorM = 0.5;
constexpr double kJerkPriorRad = 0.2;

/// Integrates rate and specific force, linear in time (constant jerk and angular acceleration), from the last
/// registered pose. A geometric observer corrects position, attitude, velocity and biases with the registration result.
class ConstantJerk : public TrajectoryModel {
 public:
  ConstantJerk(std::span<const ImuSample> samples, std::span<const RateState> rates, const StartAtRest& start,
               double gravity_m_s2)
      : samples_(samples), rates_(rates), gyro_bias_(start.gyro_bias_rad_s), gravity_m_s2_(gravity_m_s2) {
    registered_.q_WI = observer_.q_WI = start.q_WI;
  }

  baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    baselines::RigidOdometry::Motion motion;
    motion.start = registered_;
    motion.start.v_WI_m_s = observer_.v_WI_m_s;
    motion.start.time_ns = from_ns;
    motion.samples = imu_motion(samples_, rates_, gyro_bias_, from_ns, to_ns, kPartsOfSample);
    for (MotionSample& sample : motion.samples) sample.f_I_m_s2 -= accel_bias_;
    motion.gravity_m_s2 = gravity_m_s2_;
    motion.end_covariance = loose_covariance(kJerkPriorM, kJerkPriorRad);
    from_ns_ = from_ns;
    observer_.time_ns = from_ns;
    SweepTrajectory trajectory;
    if (trajectory.build(observer_, motion.samples, to_ns, gravity_m_s2_).ok()) {
      observer_ = trajectory.state(trajectory.duration_s());
    }
    return motion;
  }

  void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport& report) override {
    registered_ = odometry.state();
    if (report.verdict == SweepVerdict::rejected) return;
    const double span_s = std::min(seconds(registered_.time_ns - from_ns_), kSpanMaxS);
    const Eigen::Vector3d away = registered_.p_WI_m - observer_.p_WI_m;
    const Eigen::Vector3d rotated_I = so3::log(observer_.q_WI.conjugate() * registered_.q_WI);
    observer_.p_WI_m += span_s * kGainPosition * away;
    observer_.v_WI_m_s += span_s * kGainVelocity * away;
    observer_.q_WI = (observer_.q_WI * so3::exp(span_s * kGainAttitude * rotated_I)).normalized();
    gyro_bias_ = (gyro_bias_ - span_s * kGainGyroBias * rotated_I).cwiseMax(-kBiasMax).cwiseMin(kBiasMax);
    accel_bias_ = (accel_bias_ - span_s * kGainAccelBias * (registered_.q_WI.conjugate() * away))
                      .cwiseMax(-kBiasMax)
                      .cwiseMin(kBiasMax);
  }

 private:
  std::span<const ImuSample> samples_;
  std::span<const RateState> rates_;
  MotionState registered_, observer_;
  Eigen::Vector3d gyro_bias_, accel_bias_ = Eigen::Vector3d::Zero();
  double gravity_m_s2_;
  TimeNs from_ns_ = 0;
};

Estimate run_slam_constant_jerk(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = raw_start(sensors, samples, estimate.rates, start);
  if (!estimate.status.ok()) return estimate;
  ConstantJerk model(samples, estimate.rates, start, sensors.gravity_m_s2);
  run_rigid_chain(sensors, samples, rigid_params(sensors, parameters), model, estimate);
  return estimate;
}

}  // namespace

Method slam_constant_jerk() {
  return rig_slam({.name = "constant_jerk",
                   .doc = "Integrates the clipped gyro and the accelerometer with constant jerk within each sweep, "
                          "registers the sweep as a rigid body, and estimates velocity and biases by a geometric "
                          "observer. Not modelled: keyframes and the plane-to-plane distance of the original.",
                   .source = "the family of DLIO, Chen et al., ICRA 2023",
                   .settings = {&rigid_settings()}},
                  run_slam_constant_jerk);
}

}  // namespace tumble::scenarios
