// SPDX-License-Identifier: BSD-3-Clause
// One wild reading costs one reading.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "answers.hpp"
#include "live_readings.hpp"
#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

enum class Reading { rate, force };

/// A wild value on one axis of sample k.
struct Wild {
  const char* where;
  std::size_t k;
  Reading reading;
  int axis;
  double value;
};

std::vector<ImuSample> with_wild(std::vector<ImuSample> imu, const Wild& wild) {
  ImuSample& sample = imu[wild.k];
  (wild.reading == Reading::rate ? sample.angular_velocity_rad_s : sample.specific_force_m_s2)[wild.axis] = wild.value;
  return imu;
}

std::string name_of(const Wild& wild) {
  return std::string(wild.where) + (wild.reading == Reading::rate ? ", gyro axis " : ", accel axis ") +
         std::to_string(wild.axis) + ": " + std::to_string(wild.value);
}

struct Flight {
  double end_error_m = std::numeric_limits<double>::infinity();
  std::size_t rejected = 0;
  std::vector<PoseState> newest;  ///< after each sample
};

/// Samples as they come, each sweep when it has ended.
Flight run_tumbling(const ThrownBody& body, const std::vector<ImuSample>& imu) {
  static const std::vector<ThrownBody::Sweep> sweeps = ThrownBody().sweeps();
  TumblingOdometry odometry(params_of(body));
  std::size_t next = 0;
  Flight run;
  const auto take = [&] {
    while (const std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      const PoseState& pose = sweep->result.pose;
      run.end_error_m = (pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation()).norm();
    }
  };
  for (const ImuSample& sample : imu) {
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns; ++next)
      EXPECT_TRUE(odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
    take();
    PoseState pose;
    if (odometry.newest(pose).ok()) run.newest.push_back(pose);
  }
  odometry.finish();
  take();
  run.rejected = odometry.rejected_readings();
  return run;
}

/// Of a body that is thrown at 1.2 s, flies from 1.35 to 2.15 s, and is caught until 2.3 s.
std::vector<Wild> wild_readings() {
  return {{"at rest", 80, Reading::rate, 1, 5.0},
          {"at rest", 110, Reading::force, 2, 1e3},
          {"in flight", 180, Reading::rate, 0, -35.0},
          {"in flight", 190, Reading::force, 1, -1e4},
          {"when caught", 222, Reading::rate, 1, 2e2}};
}

TEST(Outliers, OneWildReadingCostsOneReading) {
  const ThrownBody body;
  const std::vector<ImuSample> imu = test::noisy(body.imu(), body.rail_rad_s);
  const Flight clean = run_tumbling(body, imu);
  EXPECT_EQ(clean.rejected, 0u);
  for (const Wild& wild : wild_readings()) {
    const Flight run = run_tumbling(body, with_wild(imu, wild));
    EXPECT_LT(run.end_error_m, std::max(1.2 * clean.end_error_m, clean.end_error_m + 0.005)) << name_of(wild);
    EXPECT_EQ(run.rejected, 1u) << name_of(wild);
  }
}

/// `count` wild readings, each `step` samples after the one before: equal ones, or of either sign and growing.
std::vector<ImuSample> with_wild_readings(std::vector<ImuSample> imu, Wild wild, std::size_t count, std::size_t step,
                                          bool equal) {
  for (std::size_t k = 0; k < count; ++k, wild.k += step) {
    imu = with_wild(std::move(imu), wild);
    if (!equal) wild.value *= -1.3;
  }
  return imu;
}

TEST(Outliers, SeveralWildReadingsCostAsManyReadings) {
  const ThrownBody body;
  const std::vector<ImuSample> imu = test::noisy(body.imu(), body.rail_rad_s);
  const Flight clean = run_tumbling(body, imu);
  for (const Wild& wild :
       {Wild{"at rest", 80, Reading::rate, 1, 6.0}, Wild{"at rest", 60, Reading::force, 0, 150.0},
        Wild{"in flight", 160, Reading::rate, 2, 60.0}, Wild{"in flight", 180, Reading::force, 1, -8000.0}}) {
    const std::size_t kCases[][2] = {{2, 3}, {5, 1}};  // count, step
    for (const auto& [count, step] : kCases) {
      const bool equal = count == 2;
      const Flight run = run_tumbling(body, with_wild_readings(imu, wild, count, step, equal));
      const std::string name = name_of(wild) + ", count " + std::to_string(count) + ", step " + std::to_string(step);
      EXPECT_LT(run.end_error_m, std::max(1.2 * clean.end_error_m, clean.end_error_m + 0.005)) << name;
      EXPECT_EQ(run.rejected, count) << name;
    }
  }
}

TEST(Outliers, TheNewestPoseWaitsForTheNextReading) {
  const ThrownBody body;
  const std::vector<ImuSample> imu = test::noisy(body.imu(), body.rail_rad_s);
  constexpr std::size_t kWild = 110;
  const Flight clean = run_tumbling(body, imu);
  const Flight run = run_tumbling(body, with_wild(imu, {"at rest", kWild, Reading::rate, 0, 20.0}));
  ASSERT_EQ(run.newest.size(), clean.newest.size());
  const std::size_t empty = imu.size() - run.newest.size();  // before the first sweep
  for (std::size_t k = empty; k < imu.size(); ++k) {
    const PoseState &pose = run.newest[k - empty], &expected = clean.newest[k - empty];
    // The sample after the rejected one follows a gap of two periods, so its stamp waits for the next stamp as well.
    const std::size_t newest = k == kWild ? k - 1 : k == kWild + 1 ? k - 2 : k;
    EXPECT_EQ(pose.time_ns, imu[newest].time_ns) << k;
    if (k <= kWild + 5) {
      EXPECT_LT(pose.orientation_W.angularDistance(expected.orientation_W), 1e-3) << k;
    }
  }
}

/// Samples of 100 Hz at rest.
std::vector<ImuSample> at_rest(std::size_t count) {
  std::vector<ImuSample> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    out[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    out[k].specific_force_m_s2.z() = 9.81;
  }
  return test::noisy(std::move(out));
}

std::size_t rejected_of(const std::vector<ImuSample>& samples, const OutlierFilter::ImuRanges& params = {}) {
  const std::vector<bool> inliers = find_inliers(OutlierFilter(params), samples);
  return static_cast<std::size_t>(std::count(inliers.begin(), inliers.end(), false));
}

TEST(Outliers, MotionAndImpactsPass) {
  std::vector<ImuSample> spun_up = at_rest(20);
  for (std::size_t k = 10; k < 20; ++k) spun_up[k].angular_velocity_rad_s.x() += 8.0;  // and it lasts
  EXPECT_EQ(rejected_of(spun_up), 0u);
  std::vector<ImuSample> struck = at_rest(20);
  struck[10].angular_velocity_rad_s.x() += 8.0;
  struck[10].specific_force_m_s2.y() += 60.0;  // which turns a body by 24 rad/s at most
  EXPECT_EQ(rejected_of(struck), 0u);
  struck[10].specific_force_m_s2.y() -= 55.0;
  EXPECT_EQ(rejected_of(struck), 1u);  // negative control
  std::vector<ImuSample> railed = at_rest(20);
  railed[10].angular_velocity_rad_s.x() += 8.0;
  railed[9].device_clip_flags = kClipAccelZ;  // the force may have been any
  EXPECT_EQ(rejected_of(railed), 0u);
}

TEST(Outliers, AJumpThatLastsForSixSamplesPasses) {
  for (std::size_t count = 1; count <= 7; ++count) {
    std::vector<ImuSample> samples = at_rest(40);
    for (std::size_t k = 10; k < 10 + count; ++k) samples[k].angular_velocity_rad_s.z() += 8.0;
    EXPECT_EQ(rejected_of(samples), count <= OutlierFilter::kDelayedMax ? count : 0u) << count;
  }
}

TEST(Outliers, WildReadingsAtTheStartAreRejected) {
  for (const double second : {1.0, -1.3}) {
    std::vector<ImuSample> samples = at_rest(40);
    samples[0].angular_velocity_rad_s.x() = 20.0;
    samples[1].angular_velocity_rad_s.x() = second * 20.0;
    EXPECT_EQ(rejected_of(samples), 2u) << second;
  }
}

TEST(Outliers, WhatLastsIsNoOutlierWhateverTheSheetSays) {
  std::vector<ImuSample> samples = at_rest(40);
  for (std::size_t k = 10; k < 30; ++k) samples[k].angular_velocity_rad_s.z() += 20.0;
  EXPECT_EQ(rejected_of(samples, {.gyro_range_rad_s = 4.0}), 0u);
  samples[35].angular_velocity_rad_s.z() += 20.0;
  samples[35].specific_force_m_s2.y() += 100.0;
  EXPECT_EQ(rejected_of(samples), 0u);                             // the force may have caused it
  EXPECT_EQ(rejected_of(samples, {.gyro_range_rad_s = 4.0}), 1u);  // beyond twice the stated range
}

TEST(Outliers, WhatNoSensorReadsIsMissing) {
  std::vector<ImuSample> samples = at_rest(10);
  for (std::size_t k = 4; k < 7; ++k) samples[k].angular_velocity_rad_s.y() = 2.0 * OutlierFilter::kRateMax_rad_s;
  samples[8].specific_force_m_s2.z() = -2.0 * OutlierFilter::kForceMax_m_s2;
  EXPECT_EQ(rejected_of(samples), 4u);
}

TEST(Outliers, AStampThatIsAheadCostsOneSample) {
  TumblingOdometry odometry(params_of(ThrownBody()));
  std::vector<ImuSample> imu = at_rest(200);
  const TimeNs last_ns = imu.back().time_ns;
  imu[100].time_ns += 500'000'000;
  for (const ImuSample& sample : imu) ASSERT_TRUE(odometry.add_imu(sample).ok());
  EXPECT_EQ(odometry.rejected_readings(), 1u);
  EXPECT_EQ(odometry.newest_imu_time_ns(), last_ns);
  // a right stamp after a pause is accepted
  ImuSample later = imu.back();
  for (const TimeNs step_ns : {TimeNs{300'000'000}, TimeNs{10'000'000}}) {
    later.time_ns += step_ns;
    ASSERT_TRUE(odometry.add_imu(later).ok());
  }
  EXPECT_EQ(odometry.rejected_readings(), 1u);
  EXPECT_EQ(odometry.newest_imu_time_ns(), later.time_ns);
}

TEST(Outliers, StampsBeyondAllClocksAreRefused) {
  TumblingOdometry odometry(params_of(ThrownBody()));
  ImuSample sample = at_rest(1).front();
  ASSERT_TRUE(odometry.add_imu(sample).ok());
  constexpr TimeNs kLeast = std::numeric_limits<TimeNs>::min(), kMost = std::numeric_limits<TimeNs>::max();
  for (const auto& [start_ns, end_ns] : {std::pair{kLeast, kMost}, std::pair{kMost - 5, kMost}, std::pair{kLeast, 0l}})
    EXPECT_EQ(odometry.add_sweep(start_ns, end_ns, {}).error_code, ErrorCode::out_of_range) << start_ns;
  sample.time_ns = kMost;
  EXPECT_EQ(odometry.add_imu(sample).error_code, ErrorCode::out_of_range);
}

TEST(Outliers, ACopyContinuesWhileAReadingIsDelayed) {
  const std::vector<ImuSample> imu = with_wild(at_rest(200), {"at rest", 100, Reading::force, 1, 90.0});
  TumblingOdometry one(params_of(ThrownBody())), other(params_of(ThrownBody()));
  for (std::size_t k = 0; k < imu.size(); ++k) {
    ASSERT_TRUE(one.add_imu(imu[k]).ok());
    if (k == 100) other = TumblingOdometry(one);
    if (k > 100) {
      ASSERT_TRUE(other.add_imu(imu[k]).ok());
    }
  }
  EXPECT_EQ(one.rejected_readings(), 1u);
  EXPECT_EQ(test::answers(one), test::answers(other));
}

/// How far from the true end the sphere comes to rest.
double rolling_error_m(const std::vector<std::vector<ImuSample>>& units, std::size_t& rejected) {
  const std::vector<Eigen::Vector3d> positions_m(test::kPositions.begin(),
                                                 test::kPositions.begin() + std::ptrdiff_t(units.size()));
  RollingOdometry odometry(test::params_of(positions_m));
  std::size_t poses = 0;
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    std::vector<ImuSample> now;
    for (const auto& unit : units) now.push_back(unit[k]);
    EXPECT_TRUE(odometry.add_imus(now).ok());
    while (odometry.take()) ++poses;
  }
  odometry.finish();
  while (odometry.take()) ++poses;
  rejected = odometry.rejected_readings();
  EXPECT_EQ(poses, units[0].size() - (units.size() == 1 ? rejected : 0));
  return std::abs(odometry.newest()->pose.position_W_m.x() - test::kPathLength_m);
}

TEST(Outliers, OneWildReadingMovesNoSphere) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    std::vector<std::vector<ImuSample>> units;
    for (std::size_t unit = 0; unit < count; ++unit)
      units.push_back(test::noisy(test::unit_at(test::kPositions[unit])));
    std::size_t rejected = 0;
    const double clean_m = rolling_error_m(units, rejected);
    EXPECT_EQ(rejected, 0u);
    for (const Wild& wild :
         {Wild{"at rest", 200, Reading::rate, 0, 20.0}, Wild{"rolling", 620, Reading::rate, 2, 35.0},
          Wild{"rolling", 600, Reading::force, 1, 1e3}, Wild{"rolling", 640, Reading::force, 0, 1e6}}) {
      std::vector<std::vector<ImuSample>> harmed = units;
      harmed.back() = with_wild(units.back(), wild);
      const double error_m = rolling_error_m(harmed, rejected);
      EXPECT_LT(error_m, std::max(1.2 * clean_m, clean_m + 0.005)) << name_of(wild) << ", units " << count;
      EXPECT_EQ(rejected, 1u) << name_of(wild) << ", units " << count;
      harmed.back() = with_wild_readings(units.back(), wild, 3, 1, true);
      EXPECT_LT(rolling_error_m(harmed, rejected), std::max(1.2 * clean_m, clean_m + 0.005)) << name_of(wild);
      EXPECT_EQ(rejected, 3u) << name_of(wild) << ", units " << count;
    }
  }
}

TEST(Outliers, ACopyOfASphereContinuesWhileAReadingIsDelayed) {
  std::vector<ImuSample> unit = test::noisy(test::unit_at(test::kPositions[0]));
  unit.resize(260);
  RollingOdometry one(test::params_of({test::kPositions[0]})), other(one);
  unit = with_wild(std::move(unit), {"at rest", 200, Reading::rate, 0, 20.0});
  for (std::size_t k = 0; k < unit.size(); ++k) {
    ASSERT_TRUE(one.add_imu(unit[k]).ok());
    if (k == 200) other = RollingOdometry(one);
    if (k > 200) {
      ASSERT_TRUE(other.add_imu(unit[k]).ok());
    }
  }
  EXPECT_EQ(one.rejected_readings(), 1u);
  EXPECT_EQ(test::answers(one), test::answers(other));
}

TEST(Outliers, AWildFirstSampleCostsOneSample) {
  const ThrownBody body;
  const Flight clean = run_tumbling(body, body.imu());
  for (const Wild& wild : {Wild{"first", 0, Reading::rate, 1, 20.0}, Wild{"first", 0, Reading::force, 0, 900.0}}) {
    const std::vector<ImuSample> imu = with_wild(body.imu(), wild);
    const Flight run = run_tumbling(body, imu);
    EXPECT_EQ(run.rejected, 1u) << name_of(wild);
    EXPECT_LT(run.end_error_m, clean.end_error_m + 0.01) << name_of(wild);
    const std::vector<bool> inliers = find_inliers(OutlierFilter({.period_s = 0.01}), imu);
    EXPECT_FALSE(inliers[0]) << name_of(wild);
    EXPECT_EQ(std::count(inliers.begin(), inliers.end(), false), 1) << name_of(wild);
  }
}

}  // namespace
}  // namespace tumble
