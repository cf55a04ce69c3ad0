// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

constexpr TimeNs kSilentNs = 50'000'000;  // a longer silence counts as a sensor fault
constexpr double kSwitchPriorM = 0.5;
constexpr double kSwitchPriorRad = 0.3;
constexpr double kHealthyRad = 0.05;  // rotation error with a healthy gyro

/// Uses the gyro's rotation while the gyro is healthy, else repeats the last rotation. The translation has constant
/// velocity. The gyro counts as unhealthy in sweeps with a saturated axis or a gap in the readings.
class HealthSwitch : public TrajectoryModel {
 public:
  HealthSwitch(std::span<const ImuSample> samples, std::span<const RateState> rates, const StartAtRest& start)
      : samples_(samples), rates_(rates), bias_(start.gyro_bias_rad_s) {
    last_.q_WI = start.q_WI;
  }

  baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    baselines::RigidOdometry::Motion motion;
    motion.start = last_;
    motion.start.time_ns = from_ns;
    motion.samples = imu_motion(samples_, rates_, bias_, from_ns, to_ns);
    healthy_ = std::none_of(motion.samples.begin(), motion.samples.end(), [](const MotionSample& sample) {
      return sample.clipped_axes != 0 || sample.time_ns - sample.from_ns > kSilentNs;
    });
    if (!healthy_) motion.samples = steady_motion(samples_, rate_rad_s_, Eigen::Vector3d::Zero(), from_ns, to_ns);
    for (MotionSample& sample : motion.samples) sample.f_I_m_s2.setZero();
    motion.end_covariance = loose_covariance(kSwitchPriorM, healthy_ ? kHealthyRad : kSwitchPriorRad);
    from_ns_ = from_ns;
    return motion;
  }

  void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport&) override {
    const MotionState before = last_;
    last_ = odometry.state();
    const double span_s = seconds(last_.time_ns - from_ns_);
    if (!(span_s > 0.0)) return;
    rate_rad_s_ = so3::log(before.q_WI.conjugate() * last_.q_WI) / span_s;
    last_.v_WI_m_s = (last_.p_WI_m - before.p_WI_m) / span_s;
    if (!healthy_) ++sick_sweeps_;
  }

  int sick_sweeps() const { return sick_sweeps_; }

 private:
  std::span<const ImuSample> samples_;
  std::span<const RateState> rates_;
  MotionState last_;
  Eigen::Vector3d bias_, rate_rad_s_ = Eigen::Vector3d::Zero();
  bool healthy_ = true;
  int sick_sweeps_ = 0;
  TimeNs from_ns_ = 0;
};

Estimate run_slam_health_switch(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = raw_start(sensors, samples, estimate.rates, start);
  if (!estimate.status.ok()) return estimate;
  HealthSwitch model(samples, estimate.rates, start);
  run_rigid_chain(sensors, samples, rigid_params(sensors, parameters), model, estimate);
  estimate.health["sweeps_gyro_sick"] = model.sick_sweeps();
  return estimate;
}

}  // namespace

Method slam_health_switch() {
  return rig_slam({.name = "health_switch",
                   .doc = "Uses the gyro's rotation while a monitor reports it as healthy, otherwise the last "
                          "rotation; constant velocity; rigid registration. In a tumble, no healthy source remains. "
                          "Not modelled: wheel and visual odometry, the other sources of the original.",
                   .source = "the family of LOCUS, Palieri et al., RA-L 2021",
                   .settings = {&rigid_settings()}},
                  run_slam_health_switch);
}

}  // namespace tumble::scenarios
