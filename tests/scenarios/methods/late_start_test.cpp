// SPDX-License-Identifier: BSD-3-Clause
// The test checks recordings whose sensors do not start together.
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/score.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Returns the rig at rest for `rest_s`, then half a turn in three seconds.
sim::Recording rig_that_rests(double rest_s) {
  testing::SyntheticMotion motion;
  motion.angle_rad = 3.0;
  motion.rail_rad_s = 100.0;
  motion.start_s = rest_s;
  motion.end_s = rest_s + 3.0;
  motion.duration_s = rest_s + 4.0;
  return testing::synthetic_rig(motion);
}

void start_lidar_at(double from_s, sim::LidarRecord& lidar) {
  const auto late = [&](std::int64_t start_ns) { return start_ns < from_s * kSecond_ns; };
  const auto early = std::count_if(lidar.sweep_start_ns.begin(), lidar.sweep_start_ns.end(), late);
  const std::uint64_t points = lidar.sweep_first[early];
  lidar.sweep_start_ns.erase(lidar.sweep_start_ns.begin(), lidar.sweep_start_ns.begin() + early);
  lidar.sweep_first.erase(lidar.sweep_first.begin(), lidar.sweep_first.begin() + early);
  for (std::uint64_t& first : lidar.sweep_first) first -= points;
  const auto cut = [&](auto& rows) {
    if (rows.size() >= points) rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(points));
  };
  cut(lidar.position_L_m), cut(lidar.range_m), cut(lidar.intensity), cut(lidar.offset_ns), cut(lidar.ring);
}

void start_imu_at(double from_s, sim::ImuRecord& imu) {
  const auto late = [&](std::int64_t time_ns) { return time_ns < from_s * kSecond_ns; };
  const auto early = std::count_if(imu.time_ns.begin(), imu.time_ns.end(), late);
  const auto cut = [&](auto& rows) {
    if (std::ptrdiff_t(rows.size()) >= early) rows.erase(rows.begin(), rows.begin() + early);
  };
  cut(imu.time_ns), cut(imu.gyro_rad_s), cut(imu.accel_m_s2), cut(imu.clip_flags), cut(imu.magnetic_field_t);
}

/// Declares the sweeps as deskewed: each sweep belongs to one instant.
void deskew(sim::LidarRecord& lidar) {
  for (std::uint32_t& offset_ns : lidar.offset_ns) offset_ns = 0;
  lidar.point_times = sim::PointTimes::not_skewed;
}

Estimate run_late(const std::string& name, const sim::Recording& recording) {
  return find_methods(name).at(0)->run(recording.sensors, {}, {&recording.truth});
}

double score_of(const std::string& metric, const Estimate& estimate, const sim::Recording& recording) {
  const ScoringInput input{&recording.sensors, &recording.truth, nullptr};
  for (const Score& score : score(Kind::slam, {estimate, input})) {
    if (score.metric == metric) return score.value;
  }
  ADD_FAILURE() << "no " << metric;
  return 0.0;
}

/// The methods must produce an accurate map although the lidar starts at `late_s`.
void expect_maps(double late_s, const std::vector<std::string>& methods) {
  sim::Recording recording = rig_that_rests(1.5);
  start_lidar_at(late_s, recording.sensors.lidars.front());
  for (const std::string& name : methods) {
    SCOPED_TRACE(name);
    const Estimate estimate = run_late(name, recording);
    ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
    ASSERT_FALSE(estimate.poses.empty());
    EXPECT_GT(estimate.map.size(), 1000u);
    EXPECT_GE(estimate.poses.front().time_ns, static_cast<std::int64_t>((late_s - 0.02) * kSecond_ns));
    EXPECT_EQ(estimate.health.count("sweeps_rejected"), 0u);
    EXPECT_LT(score_of("ate_m", estimate, recording), 0.05);
  }
}

TEST(LateLidar, AMapThatStartsInMotionIsAccurate) {
  expect_maps(3.0, {"slam/tumble", "slam/icp"});
}

TEST(LateLidarSoak, EveryMethodOverTheMapperMaps) {
  expect_maps(1.0, {"slam/tumble", "slam/tumble_lag", "slam/tumble_live", "slam/oracle", "slam/icp", "slam/icp_raw"});
  expect_maps(3.0, {"slam/tumble_lag", "slam/tumble_live", "slam/oracle", "slam/icp_raw"});
}

TEST(LateImu, SweepsBeforeItAreLeftOutAndCounted) {
  sim::Recording recording = rig_that_rests(4.0);
  start_imu_at(2.55, recording.sensors.imus.front());
  for (const char* const name : {"slam/tumble", "slam/tumble_lag", "slam/tumble_live"}) {
    SCOPED_TRACE(name);
    const Estimate estimate = run_late(name, recording);
    ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
    EXPECT_LT(score_of("ate_m", estimate, recording), 0.05);
    double left_out = 0.0;
    for (const char* const key : {"sweeps_before_imu", "sweeps_unfinished", "sweeps_too_few"}) {
      if (const auto found = estimate.health.find(key); found != estimate.health.end()) left_out += found->second;
    }
    EXPECT_GE(left_out, 25.0);
    EXPECT_LE(left_out, 27.0);
  }
}

// The lidar's clock is 5 ms late, so its last sweep ends after the last IMU sample.
TEST(LastSweep, ThatTheImuDoesNotCoverIsCounted) {
  sim::Recording recording = rig_that_rests(1.5);
  for (std::int64_t& start_ns : recording.sensors.lidars.front().sweep_start_ns) start_ns += 5'000'000;
  for (const char* const name : {"slam/tumble_lag", "slam/tumble_live", "slam/icp_raw"}) {
    SCOPED_TRACE(name);
    const Estimate estimate = run_late(name, recording);
    ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
    EXPECT_EQ(estimate.health.at("sweeps_unfinished"), 1.0);
  }
}

TEST(LateImu, ADeskewedSweepBeforeItIsLeftOut) {
  sim::Recording recording = rig_that_rests(1.5);
  start_imu_at(0.055, recording.sensors.imus.front());
  deskew(recording.sensors.lidars.front());
  for (const char* const name : {"slam/tumble", "slam/tumble_lag", "slam/icp"}) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(run_late(name, recording).status.ok()) << run_late(name, recording).status.message();
  }
}

}  // namespace
}  // namespace tumble::scenarios
