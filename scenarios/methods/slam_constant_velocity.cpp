// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/slam_constant_velocity.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/types.hpp"

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
       .doc = "Uses the lidar only: predicts the pose with constant velocity, deskews each sweep once, and registers "
              "the rigid sweep by point-to-plane ICP. During tumbling, the rate changes too much between two sweeps "
              "for this method. Without point times, the method does not deskew. The method lacks the adaptive "
              "threshold and the point-to-point distance of KISS-ICP.",
       .source = "similar to KISS-ICP, Vizzo et al., RA-L 2023",
       .settings = {&rigid_settings()},
       .robots = {"rig"}},
      run_slam_constant_velocity);
}

namespace {

constexpr double kRestMaxS = 1.0;
/// The thresholds for a stationary rig at the start of a recording are those of the mapper
/// (`mapping_stationary_params`), without the gravity test.
constexpr RestDetector::Params kStart = {.rate_spread_rad_s = 0.05, .force_spread_m_s2 = 0.5, .rest_s = 0.0};
constexpr double kVelocitySigmaMS = 1e-4;  // registration measures no velocity

TimeNs window_start(std::span<const ImuSample> samples, std::size_t k) {
  if (k > 0) return samples[k - 1].time_ns;
  return samples.size() > 1 ? 2 * samples[0].time_ns - samples[1].time_ns : samples[0].time_ns;
}

template <typename Add>
void for_windows(std::span<const ImuSample> samples, TimeNs from_ns, TimeNs to_ns, Add add) {
  const auto first = std::upper_bound(samples.begin(), samples.end(), from_ns,
                                      [](TimeNs t, const ImuSample& sample) { return t < sample.time_ns; });
  for (auto it = first; it != samples.end(); ++it) {
    const auto k = static_cast<std::size_t>(it - samples.begin());
    const TimeNs start = window_start(samples, k);
    if (it != first && start >= to_ns) break;
    add(k, it == first ? std::min(start, from_ns) : start, it->time_ns);
  }
}

}  // namespace

Status start_at_rest(std::span<const ImuSample> samples, StartAtRest& out) {
  if (samples.empty()) return {ErrorCode::insufficient_data, "imu samples", 0.0, 1.0};
  const RestDetector detector(kStart);
  RestDetector::State state, rest;
  for (const ImuSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().time_ns) > kRestMaxS) break;
    if (!detector.detect_stationary(sample, state) || state.first_ns != samples.front().time_ns) break;
    rest = state;
  }
  out.gyro_bias_rad_s = rest.mean_rate_rad_s();
  return inclination_from_force(rest.is_stationary ? rest.mean_force_m_s2() : samples.front().specific_force_m_s2,
                                out.q_WI);
}

std::vector<MotionSample> steady_motion(std::span<const ImuSample> samples, const Eigen::Vector3d& rate_I_rad_s,
                                        const Eigen::Vector3d& force_I_m_s2, TimeNs from_ns, TimeNs to_ns) {
  std::vector<MotionSample> motion;
  for_windows(samples, from_ns, to_ns, [&](std::size_t, TimeNs start, TimeNs end) {
    MotionSample& sample = motion.emplace_back();
    sample.from_ns = start;
    sample.time_ns = end;
    sample.w_WI_I_rad_s = rate_I_rad_s;
    sample.f_I_m_s2 = force_I_m_s2;
  });
  return motion;
}

Eigen::Matrix<double, 9, 9> loose_covariance(double sigma_m, double sigma_rad) {
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  covariance.diagonal().segment<3>(3).setConstant(sigma_rad * sigma_rad);
  covariance.diagonal().tail<3>().setConstant(kVelocitySigmaMS * kVelocitySigmaMS);
  return covariance;
}

void run_rigid_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     const baselines::RigidOdometry::Params& params, TrajectoryModel& model, Estimate& estimate) {
  if (sensors.lidars.empty()) {
    estimate.status = {ErrorCode::empty, "lidars", 0.0, 1.0};
    return;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  if (bridge::sweep_count(lidar) == 0) {
    estimate.status = {ErrorCode::empty, "lidar.sweep_start_ns", 0.0, 1.0};
    return;
  }
  baselines::RigidOdometry odometry(params);
  std::optional<TimeNs> last_end_ns;
  const auto covers = [&](const bridge::Sweep& sweep) {
    return samples.back().time_ns >= sweep.end_ns && window_start(samples, 0) <= sweep.start_ns &&
           sweep.start_ns >= last_end_ns.value_or(sweep.start_ns);
  };
  const auto add = [&](const bridge::Sweep& sweep, SweepReport& report) {
    const auto motion = model.expect(last_end_ns.value_or(sweep.start_ns), sweep.end_ns);
    const Status status = odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, motion, report);
    if (!status.ok() && report.trajectory.empty()) return status;
    model.learn(odometry, report);
    last_end_ns = sweep.end_ns;
    return status;
  };
  if (run_over_sweeps(lidar, {covers, add}, estimate)) estimate.map = odometry.map();
}

const Settings<baselines::RigidOdometry::Params>& rigid_settings() {
  static const Settings<baselines::RigidOdometry::Params> all = [] {
    baselines::RigidOdometry::Params params;
    params.own_body_L = presets::rig_body_L();
    params.registration.neighbours = 12;  // as in LidarInertialOdometry
    params.registration.skew_sigma_m_s = 0.0;
    return Settings<baselines::RigidOdometry::Params>(params, {});
  }();
  return all;
}

baselines::RigidOdometry::Params rigid_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  baselines::RigidOdometry::Params params = rigid_settings().read(parameters);
  if (!sensors.lidars.empty() && !sensors.imus.empty())
    params.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  params.registration.expert.plane.neighbours_min =
      std::min(params.registration.expert.plane.neighbours_min, params.registration.neighbours);
  return params;
}

}  // namespace tumble::scenarios
