// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"
#include "sim/situation.hpp"
#include "tests/tree.hpp"
#include "tools/replay/replay.hpp"

/// The functions here give a body on a known path through an empty room: all readings follow in closed form.
namespace tumble::tools::testing {

inline constexpr std::int64_t kPeriod_ns = 1'000'000;
inline constexpr double kSpin_rad_s = 2.0;
inline constexpr double kHeight_m = 0.5;

/// Returns a pose that turns about z at kSpin_rad_s while it moves along x at 1 m/s.
inline Eigen::Isometry3d known_pose(std::int64_t time_ns) {
  const double t = 1e-9 * static_cast<double>(time_ns);
  Eigen::Isometry3d T_WB(Eigen::AngleAxisd(kSpin_rad_s * t, Eigen::Vector3d::UnitZ()));
  T_WB.translation() = Eigen::Vector3d(t, 0.0, kHeight_m);
  return T_WB;
}

inline sim::Truth known_truth(int samples = 1001) {
  sim::Truth truth;
  truth.period_ns = kPeriod_ns;
  for (int k = 0; k < samples; ++k) {
    const Eigen::Isometry3d T_WB = known_pose(k * kPeriod_ns);
    truth.p_WB_m.emplace_back(T_WB.translation());
    truth.q_WB.emplace_back(T_WB.linear());
    truth.v_WB_m_s.emplace_back(1.0, 0.0, 0.0);
    truth.w_WB_B_rad_s.emplace_back(0.0, 0.0, kSpin_rad_s);
    truth.label.push_back(k >= 200 && k < 300 ? sim::ContactLabel::slip : sim::ContactLabel::air);
  }
  truth.imus.resize(1);
  return truth;
}

/// Returns an IMU whose z axis is saturated at 1.5 rad/s from 0.4 to 0.6 s, and a lidar at the body's origin: two
/// sweeps of 320 returns of 16 beams and between them an empty one; every return lies on the floor below or 0.25 m
/// above it.
inline sim::Recording known_recording() {
  sim::Recording recording;
  recording.truth = known_truth();
  sim::Sensors& sensors = recording.sensors;
  sensors.robot = "sphere";
  sensors.sphere_radius_m = 0.145;
  sensors.imus.resize(1);
  sim::ImuRecord& imu = sensors.imus[0];
  sim::ImuTruth& true_imu = recording.truth.imus[0];
  imu.period_ns = 10'000'000;
  for (int k = 0; k <= 100; ++k) {
    const bool clipped = k >= 40 && k < 60;
    imu.time_ns.push_back(k * imu.period_ns);
    imu.gyro_rad_s.emplace_back(0.0, 0.0, clipped ? 1.5 : kSpin_rad_s);
    imu.accel_m_s2.emplace_back(0.0, 0.0, 9.8);
    imu.clip_flags.push_back(0);
    true_imu.rate_rad_s.emplace_back(0.0, 0.0, kSpin_rad_s);
    true_imu.gyro_unclipped_rad_s.emplace_back(0.0, 0.0, kSpin_rad_s);
  }
  sensors.lidars.resize(1);
  sim::LidarRecord& lidar = sensors.lidars[0];
  lidar.sweep_period_ns = 100'000'000;
  lidar.sweep_start_ns = {100'000'000, 200'000'000, 300'000'000};
  lidar.sweep_first = {0, 320, 320, 640};
  recording.truth.lidars.resize(1);
  for (int i = 0; i < 640; ++i) {
    const double height_m = i % 32 < 16 ? 0.0 : 0.25;
    lidar.position_L_m.emplace_back(0.6f + 0.001f * static_cast<float>(i), 0.0f,
                                    static_cast<float>(height_m - kHeight_m));
    lidar.range_m.push_back(lidar.position_L_m.back().norm());
    lidar.intensity.push_back(0.5f);
    lidar.offset_ns.push_back(static_cast<std::uint32_t>(i % 320) * 200'000);
    lidar.ring.push_back(static_cast<std::uint16_t>(i % 16));
    recording.truth.lidars[0].hit_W_m.emplace_back(0, 0, 0);
    recording.truth.lidars[0].surface_id.push_back(0);
  }
  return recording;
}

/// Returns the known path in another world frame, turned and moved; rates start at 0.2 s.
inline scenarios::Estimate known_estimate(scenarios::Frame frame, const Eigen::Isometry3d& T_BA,
                                          const Eigen::Isometry3d& T_VW) {
  scenarios::Estimate estimate;
  estimate.frame = frame;
  for (std::int64_t t = 0; t <= 1'000'000'000; t += 10'000'000) {
    const Eigen::Isometry3d T_VA = T_VW * known_pose(t) * T_BA;
    PoseState pose;
    pose.time_ns = t;
    pose.position_W_m = T_VA.translation();
    pose.orientation_W = Eigen::Quaterniond(T_VA.linear());
    estimate.poses.push_back(pose);
    if (t < 200'000'000) continue;
    AngularRateState rate;
    rate.time_ns = t;
    rate.w_WI_I_rad_s = {0.0, 0.0, 3.0};
    rate.clipped_axes = t >= 700'000'000 ? 4 : 0;
    estimate.rates.push_back(rate);
  }
  return estimate;
}

inline Eigen::Isometry3d other_world() {
  return Eigen::Translation3d(3, -4, 1) * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ());
}

/// Returns an empty square room with its floor at z = 0.
inline const sim::BuiltSituation& room() {
  static const sim::BuiltSituation built = [] {
    sim::Situation situation;
    situation.scenario = "test";
    situation.world.type = "floor";
    for (const char* none : {"pillar_count", "box_count"}) situation.world.values.set(none, 0.0);
    situation.robot.type = "sphere";
    situation.motion.type = "hand_roll";
    return sim::BuiltSituation(sim::resolve(situation), test::source_dir() / "models");
  }();
  return built;
}

}  // namespace tumble::tools::testing
