// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/lidar_odometry.hpp"

#include <algorithm>
#include <optional>

#include "scenarios/baselines/mapping/rigid_odometry.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

using baselines::RigidOdometry;

constexpr int kPosesPerSweep = 10;

// The prior of the sweep's pose is very weak, so registration alone determines the pose.
constexpr double kPriorM = 1.0, kPriorRad = 0.5;
constexpr double kVelocitySigmaMS = 1e-4;  // registration measures no velocity

RigidOdometry::Params rigid_params() {
  RigidOdometry::Params params;
  params.own_body_L = presets::rig_body_L();
  params.registration.neighbours = 12;  // as in LidarInertialOdometry
  params.registration.skew_sigma_m_s = 0.0;
  return params;
}

std::vector<TimeNs> pose_times(const sim::LidarRecord& lidar) {
  std::vector<TimeNs> out;
  const std::size_t sweeps = bridge::sweep_count(lidar);
  const auto step_to = [&](TimeNs from_ns, TimeNs to_ns) {
    for (int k = 1; k <= kPosesPerSweep; ++k) {
      const TimeNs at_ns = from_ns + (to_ns - from_ns) * k / kPosesPerSweep;
      if (out.empty() || at_ns > out.back()) out.push_back(at_ns);
    }
  };
  for (std::size_t k = 0; k + 1 < sweeps; ++k) step_to(lidar.sweep_start_ns[k], lidar.sweep_start_ns[k + 1]);
  if (sweeps > 0) step_to(lidar.sweep_start_ns.back(), lidar.sweep_start_ns.back() + lidar.sweep_period_ns);
  return out;
}

/// ConstantVelocity predicts that the pose change over the last sweep repeats, in translation and rotation.
class ConstantVelocity {
 public:
  ConstantVelocity(std::vector<TimeNs> times, const Eigen::Quaterniond& q_WL) : times_(std::move(times)) {
    last_.q_WI = q_WL;
  }

  bool covers(TimeNs from_ns, TimeNs to_ns) const { return times_.back() >= to_ns && interval_start(0) <= from_ns; }

  RigidOdometry::Motion expect(TimeNs from_ns, TimeNs to_ns) {
    RigidOdometry::Motion motion;
    motion.start = last_;
    motion.start.time_ns = from_ns;
    const auto first = std::upper_bound(times_.begin(), times_.end(), from_ns);
    for (auto at = first; at != times_.end(); ++at) {
      const TimeNs start = interval_start(static_cast<std::size_t>(at - times_.begin()));
      if (at != first && start >= to_ns) break;
      MotionSample& sample = motion.samples.emplace_back();
      sample.from_ns = at == first ? std::min(start, from_ns) : start;
      sample.time_ns = *at;
      sample.w_WI_I_rad_s = rate_rad_s_;
      sample.f_I_m_s2 = Eigen::Vector3d::Zero();
    }
    motion.end_covariance.diagonal().head<3>().setConstant(kPriorM * kPriorM);
    motion.end_covariance.diagonal().segment<3>(3).setConstant(kPriorRad * kPriorRad);
    motion.end_covariance.diagonal().tail<3>().setConstant(kVelocitySigmaMS * kVelocitySigmaMS);
    from_ns_ = from_ns;
    return motion;
  }

  void update(const MotionState& state) {
    const MotionState before = last_;
    last_ = state;
    const double span_s = seconds(last_.time_ns - from_ns_);
    if (!(span_s > 0.0)) return;
    rate_rad_s_ = so3::logarithm(before.q_WI.conjugate() * last_.q_WI) / span_s;
    last_.v_WI_m_s = (last_.p_WI_m - before.p_WI_m) / span_s;
  }

 private:
  TimeNs interval_start(std::size_t k) const {
    if (k > 0) return times_[k - 1];
    return times_.size() > 1 ? 2 * times_[0] - times_[1] : times_[0];
  }

  std::vector<TimeNs> times_;
  MotionState last_;
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
  TimeNs from_ns_ = 0;
};

}  // namespace

std::vector<SweepResult> register_sweeps(const sim::LidarRecord& lidar) {
  if (bridge::sweep_count(lidar) == 0) return {};
  ConstantVelocity model(pose_times(lidar), Eigen::Quaterniond(lidar.T_BL.linear()));
  RigidOdometry odometry(rigid_params());
  std::optional<TimeNs> last_end_ns;
  const auto covers = [&](const bridge::Sweep& sweep) {
    return model.covers(sweep.start_ns, sweep.end_ns) && sweep.start_ns >= last_end_ns.value_or(sweep.start_ns);
  };
  const auto add = [&](const bridge::Sweep& sweep, SweepResult& report) {
    const auto motion = model.expect(last_end_ns.value_or(sweep.start_ns), sweep.end_ns);
    const Status status = odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, motion, report);
    if (!status.ok() && report.trajectory.empty()) return status;
    model.update(odometry.state());
    last_end_ns = sweep.end_ns;
    return status;
  };
  Estimate estimate;
  run_over_sweeps(lidar, {covers, add}, estimate);
  return std::move(estimate.sweeps);
}

}  // namespace tumble::scenarios
