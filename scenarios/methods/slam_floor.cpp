// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/rigid_chain.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kFloorPriorM = 0.05;
constexpr double kFloorPriorRad = 0.02;

/// TrueMotion predicts the true motion of the IMU since the sweep's start, at every simulation step, in body axes.
class TrueMotion : public TrajectoryModel {
 public:
  TrueMotion(const sim::Truth& truth, const StartAtRest& start) : truth_(truth), T_BI_(truth.imus.front().T_BI) {
    last_.q_WI = start.q_WI;
  }

  baselines::RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) override {
    baselines::RigidOdometry::Motion motion;
    const auto first = static_cast<std::size_t>(std::max<TimeNs>(from_ns / truth_.period_ns, 0));
    // Only the motion within the sweep comes from the truth, so the true attitude is aligned with the estimate at the
    // start.
    const Eigen::Quaterniond to_estimate = last_.q_WI * attitude(first).conjugate();
    motion.start = last_;
    motion.start.time_ns = from_ns;
    motion.start.v_WI_m_s = to_estimate * velocity(first);
    const double step_s = seconds(truth_.period_ns);
    for (std::size_t k = first; static_cast<TimeNs>(k) * truth_.period_ns < to_ns && k + 1 < truth_.q_WB.size(); ++k) {
      MotionSample& sample = motion.samples.emplace_back();
      sample.from_ns = static_cast<TimeNs>(k) * truth_.period_ns;
      sample.time_ns = sample.from_ns + truth_.period_ns;
      const Eigen::Vector3d turned = so3::log(attitude(k).conjugate() * attitude(k + 1));
      sample.w_WI_I_rad_s = turned / step_s;
      sample.f_I_m_s2 = (attitude(k) * so3::exp(0.5 * turned)).conjugate() * ((velocity(k + 1) - velocity(k)) / step_s);
    }
    motion.end_covariance = loose_covariance(kFloorPriorM, kFloorPriorRad);
    return motion;
  }

  void learn(const baselines::RigidOdometry& odometry, const LidarInertialOdometry::SweepReport&) override {
    last_ = odometry.state();
  }

 private:
  Eigen::Quaterniond attitude(std::size_t k) const { return truth_.q_WB[k] * Eigen::Quaterniond(T_BI_.linear()); }
  Eigen::Vector3d velocity(std::size_t k) const {
    return truth_.v_WB_m_s[k] + truth_.q_WB[k] * truth_.w_WB_B_rad_s[k].cross(T_BI_.translation());
  }

  const sim::Truth& truth_;
  Eigen::Isometry3d T_BI_;
  MotionState last_;
};

Estimate run_slam_floor(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  StartAtRest start;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = start_at_rest(samples, start);
  if (estimate.status.ok()) estimate.status = unclipped_rates(sensors, *oracle.truth, estimate.rates);
  if (!estimate.status.ok()) return estimate;
  baselines::RigidOdometry::Params params = rigid_params(sensors, parameters);
  if (!oracle.truth->lidars.empty()) {
    params.T_IL = oracle.truth->imus.front().T_BI.inverse(Eigen::Isometry) * oracle.truth->lidars.front().T_BL;
  }
  TrueMotion model(*oracle.truth, start);
  run_rigid_chain(sensors, samples, params, model, estimate);
  return estimate;
}

}  // namespace

Method slam_floor() {
  return rig_slam({.name = "floor",
                   .doc = "Gives an upper bound of the accuracy: registration receives the true motion within each "
                          "sweep and the true mounting. Errors of registration and map remain.",
                   .ours = true,
                   .settings = {&rigid_settings()},
                   .needs_truth = true},
                  run_slam_floor);
}

}  // namespace tumble::scenarios
