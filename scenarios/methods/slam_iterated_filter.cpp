// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

// These standard deviations of one gyro reading and one accelerometer reading are process noise in the authors'
// settings.
constexpr double kGyroSigmaRadS = 0.316;
constexpr double kAccelSigmaMS2 = 0.316;
constexpr double kStartSigmaMS = 0.1;

/// Error-state Kalman filter with iterated updates. The filter predicts by strapdown integration with covariance and
/// deskews the points to the sweep's end. The filter then updates position, attitude and velocity iteratively with all
/// planes.
class IteratedFilter : public TrajectoryModel {
 public:
  IteratedFilter(std::span<const ImuSample> samples, std::span<const RateState> rates, const StartAtRest& start,
                 double gravity_m_s2)
      : samples_(samples), rates_(rates), bias_(start.gyro_bias_rad_s), gravity_m_s2_(gravity_m_s2) {
    state_.q_WI = start.q_WI;
    state_.covariance.diagonal().tail<3>().setConstant(kStartSigmaMS * kStartSigmaMS);
  }

  baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    baselines::RigidOdometry::Motion motion;
    motion.start = state_;
    motion.start.time_ns = from_ns;
    motion.samples = imu_motion(samples_, rates_, bias_, from_ns, to_ns);
    motion.gravity_m_s2 = gravity_m_s2_;
    // The prediction propagates the covariance of the start, and adds the noise of each step from the time of the step
    // on.
    SweepTrajectory trajectory;
    if (!trajectory.build(motion.start, motion.samples, to_ns, gravity_m_s2_).ok()) return motion;
    motion.end_covariance = trajectory.state(trajectory.duration_s()).covariance;
    for (const MotionSample& sample : motion.samples) {
      const double step_s = seconds(std::min(sample.time_ns, to_ns) - std::max(sample.from_ns, from_ns));
      const double left_s = std::max(seconds(to_ns - sample.time_ns), 0.0);
      if (!(step_s > 0.0)) continue;
      const double turned = kGyroSigmaRadS * step_s, pushed = kAccelSigmaMS2 * step_s;
      motion.end_covariance.diagonal().head<3>().array() += pushed * pushed * left_s * left_s;
      motion.end_covariance.diagonal().segment<3>(3).array() += turned * turned;
      motion.end_covariance.diagonal().tail<3>().array() += pushed * pushed;
      motion.end_covariance.block<3, 3>(0, 6).diagonal().array() += pushed * pushed * left_s;
      motion.end_covariance.block<3, 3>(6, 0).diagonal().array() += pushed * pushed * left_s;
    }
    return motion;
  }

  void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport&) override {
    state_ = odometry.state();
  }

 private:
  std::span<const ImuSample> samples_;
  std::span<const RateState> rates_;
  MotionState state_;
  Eigen::Vector3d bias_;
  double gravity_m_s2_;
};

Estimate run_slam_iterated_filter(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = raw_start(sensors, samples, estimate.rates, start);
  if (!estimate.status.ok()) return estimate;
  IteratedFilter model(samples, estimate.rates, start, sensors.gravity_m_s2);
  run_rigid_chain(sensors, samples, rigid_params(sensors, parameters), model, estimate);
  return estimate;
}

}  // namespace

Method slam_iterated_filter() {
  return rig_slam({.name = "iterated_filter",
                   .doc = "Iterated error-state filter with the clipped gyro. Back-propagation deskews to the end of "
                          "the sweep; all planes update position, attitude and velocity. Not modelled: biases after "
                          "the initial rest, gravity and mounting as states.",
                   .source = "the family of FAST-LIO2, Xu et al., T-RO 2022",
                   .settings = {&rigid_settings()}},
                  run_slam_iterated_filter);
}

}  // namespace tumble::scenarios
