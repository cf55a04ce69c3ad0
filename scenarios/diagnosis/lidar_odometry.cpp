// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/lidar_odometry.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "scenarios/baselines/mapping/rigid_odometry.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

using baselines::RigidOdometry;

constexpr int kPosesPerSweep = 10;
constexpr std::size_t kSpans = 10, kSweepsOfSpan = 12;
constexpr double kSlowest_rad_s = 0.1, kFastest_rad_s = 2.0;

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

sim::LidarRecord span_alone(const sim::LidarRecord& lidar, const PointStore* aside, std::size_t first,
                            std::size_t last) {
  sim::LidarRecord out = sweep_alone(lidar, aside, first);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (std::size_t k = first + 1; k < last; ++k) {
    const sim::LidarRecord sweep = sweep_alone(lidar, aside, k);
    append(out.sweep_start_ns, sweep.sweep_start_ns);
    append(out.position_L_m, sweep.position_L_m);
    append(out.range_m, sweep.range_m);
    append(out.intensity, sweep.intensity);
    append(out.offset_ns, sweep.offset_ns);
    append(out.ring, sweep.ring);
    out.sweep_first.push_back(out.position_L_m.size());
  }
  return out;
}

/// Registration determines the pose at the mean time of the points of a sweep. The pose at the end of the sweep also
/// depends on the rate that deskews the sweep, which is the rate of the previous sweep.
const PoseState& middle_pose(const SweepResult& sweep, std::int64_t half_ns) {
  return *std::ranges::min_element(sweep.trajectory, {}, [&](const PoseState& pose) {
    return std::abs(pose.time_ns + half_ns - sweep.pose.time_ns);
  });
}

void add_rotations(std::span<const SweepResult> sweeps, std::int64_t half_ns, std::vector<SeenRotation>& out) {
  const auto registered = [](const SweepResult& sweep) {
    return sweep.verdict == SweepVerdict::first || sweep.verdict == SweepVerdict::registered;
  };
  for (std::size_t k = 1; k < sweeps.size(); ++k) {
    if (!registered(sweeps[k - 1]) || !registered(sweeps[k])) continue;
    const PoseState &before = middle_pose(sweeps[k - 1], half_ns), &after = middle_pose(sweeps[k], half_ns);
    SeenRotation seen{before.time_ns, after.time_ns,
                      so3::logarithm(before.orientation_W.conjugate() * after.orientation_W)};
    const double length_s = seconds(seen.to_ns - seen.from_ns), angle_rad = seen.rotation_L_rad.norm();
    if (angle_rad > kSlowest_rad_s * length_s && angle_rad < kFastest_rad_s * length_s) out.push_back(seen);
  }
}

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

std::vector<SeenRotation> seen_rotations(const sim::LidarRecord& lidar, const PointStore* aside) {
  std::vector<SeenRotation> out;
  const std::size_t sweeps = lidar.sweep_start_ns.size();
  const std::size_t spans = std::min(kSpans, (sweeps + kSweepsOfSpan - 1) / kSweepsOfSpan);
  const std::int64_t half_ns = lidar.point_times == sim::PointTimes::measured ? lidar.sweep_period_ns / 2 : 0;
  for (std::size_t k = 0; k < spans; ++k) {
    const std::size_t first = k * sweeps / spans, last = std::min(first + kSweepsOfSpan, sweeps);
    add_rotations(register_sweeps(span_alone(lidar, aside, first, last)), half_ns, out);
  }
  return out;
}

}  // namespace tumble::scenarios
