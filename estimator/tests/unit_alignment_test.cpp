// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/imu_time_alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "rolled_sphere.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::kPathLength_m, test::kPositions, test::params_of, test::unit_at;

constexpr TimeNs kPeriod_ns = 4'000'000;

/// A unit whose rate about x is 2 rad/s^2 times the time, so that linear interpolation is exact.
std::vector<ImuSample> ramp(TimeNs first_ns, int count) {
  std::vector<ImuSample> out;
  for (int k = 0; k < count; ++k) {
    ImuSample sample;
    sample.time_ns = first_ns + k * kPeriod_ns;
    sample.angular_velocity_rad_s.x() = 2.0 * seconds(sample.time_ns);
    out.push_back(sample);
  }
  return out;
}

/// The readings of all units in order of time: (unit, reading).
std::vector<std::pair<std::size_t, ImuSample>> in_time_order(const std::vector<std::vector<ImuSample>>& units) {
  std::vector<std::pair<std::size_t, ImuSample>> out;
  for (std::size_t unit = 0; unit < units.size(); ++unit) {
    for (const ImuSample& sample : units[unit]) out.emplace_back(unit, sample);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.second.time_ns < b.second.time_ns; });
  return out;
}

std::vector<ImuTimeAlignment::Readings> aligned(const std::vector<std::vector<ImuSample>>& units, bool ended = true) {
  const ImuTimeAlignment alignment(units.size());
  ImuTimeAlignment::State state;
  ImuTimeAlignment::Readings readings;
  std::vector<ImuTimeAlignment::Readings> out;
  for (const auto& [unit, sample] : in_time_order(units)) {
    EXPECT_TRUE(alignment.push(unit, sample, state).ok());
    while (alignment.next(state, readings)) out.push_back(readings);
  }
  while (ended && alignment.next(state, readings, true)) out.push_back(readings);
  return out;
}

TEST(ImuTimeAlignment, InterpolatesAtTheStampsOfTheFirstUnit) {
  const auto out = aligned({ramp(0, 200), ramp(1'300'000, 200), ramp(-2'700'000, 200)});
  ASSERT_EQ(out.size(), 200U);
  for (std::size_t k = 1; k + 1 < out.size(); ++k) {
    for (std::size_t unit = 0; unit < 3; ++unit) {
      EXPECT_EQ(out[k][unit].time_ns, static_cast<TimeNs>(k) * kPeriod_ns);
      EXPECT_NEAR(out[k][unit].angular_velocity_rad_s.x(), 2.0 * seconds(out[k][unit].time_ns), 1e-12);
    }
  }
}

TEST(ImuTimeAlignment, EqualStampsAreUnchangedAndComeAtOnce) {
  const auto out = aligned({ramp(0, 50), ramp(0, 50)}, false);
  ASSERT_EQ(out.size(), 50U);
  for (std::size_t k = 0; k < out.size(); ++k)
    EXPECT_EQ(out[k][1].angular_velocity_rad_s, ramp(0, 50)[k].angular_velocity_rad_s) << k;
}

TEST(ImuTimeAlignment, AUnitThatEndsIsAbsentAndDelaysNothingForLong) {
  const auto out = aligned({ramp(0, 500), ramp(1'000'000, 100)}, false);
  ASSERT_EQ(out.size(), 500U);
  EXPECT_TRUE(is_finite(out[90][1]));
  EXPECT_FALSE(is_finite(out[110][1]));
  EXPECT_TRUE(is_finite(out[110][0]));
}

TEST(ImuTimeAlignment, TheNextUnitReplacesAReferenceThatEnds) {
  const auto out = aligned({ramp(0, 100), ramp(0, 300), ramp(1'000'000, 300)});
  ASSERT_EQ(out.size(), 300U);
  EXPECT_FALSE(is_finite(out[200][0]));
  EXPECT_EQ(out[200][1].time_ns, 200 * kPeriod_ns);
  EXPECT_TRUE(is_finite(out[200][2]));
}

TEST(ImuTimeAlignment, TheOutputIsCausal) {
  const std::vector<std::vector<ImuSample>> units = {ramp(0, 300), ramp(1'300'000, 80), ramp(700'000, 300)};
  const auto whole = aligned(units, false);
  for (const std::size_t cut : {50U, 79U, 120U}) {
    std::vector<std::vector<ImuSample>> before = units;
    for (auto& unit : before)
      std::erase_if(unit, [&](const ImuSample& s) { return s.time_ns > static_cast<TimeNs>(cut) * kPeriod_ns; });
    const auto part = aligned(before, false);
    ASSERT_GT(part.size() + 20, cut);
    for (std::size_t k = 0; k < part.size(); ++k) {
      for (std::size_t unit = 0; unit < 3; ++unit) {
        EXPECT_EQ(is_finite(part[k][unit]), is_finite(whole[k][unit])) << cut << ' ' << k;
        if (is_finite(part[k][unit])) {
          EXPECT_EQ(part[k][unit].angular_velocity_rad_s, whole[k][unit].angular_velocity_rad_s);
        }
      }
    }
  }
}

TEST(ImuTimeAlignment, AStampThatGoesBackIsRejected) {
  const ImuTimeAlignment alignment(2);
  ImuTimeAlignment::State state;
  const std::vector<ImuSample> samples = ramp(0, 2);
  ASSERT_TRUE(alignment.push(1, samples[1], state).ok());
  EXPECT_EQ(alignment.push(1, samples[0], state).error_code, ErrorCode::time_order);
  EXPECT_TRUE(alignment.push(0, samples[0], state).ok()) << "the stamps of two units are independent";
}

std::vector<RollingOdometry::Pose> poses_of(RollingOdometry& odometry,
                                            const std::vector<std::vector<ImuSample>>& units) {
  std::vector<RollingOdometry::Pose> out;
  const auto take = [&] {
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) out.push_back(*pose);
  };
  for (const auto& [unit, sample] : in_time_order(units)) {
    EXPECT_TRUE(odometry.add_imu(unit, sample).ok());
    take();
  }
  EXPECT_TRUE(odometry.finish().ok());
  take();
  return out;
}

std::vector<std::vector<ImuSample>> three_units() {
  std::vector<std::vector<ImuSample>> units;
  for (const Eigen::Vector3d& position_m : kPositions) units.push_back(unit_at(position_m));
  return units;
}

TEST(RollingOdometryUnits, SingleReadingsGiveTheBitsOfSimultaneousOnes) {
  const std::vector<std::vector<ImuSample>> units = three_units();
  RollingOdometry together(params_of(kPositions)), single(params_of(kPositions));
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    const std::vector<ImuSample> now = {units[0][k], units[1][k], units[2][k]};
    ASSERT_TRUE(together.add_imus(now).ok());
  }
  ASSERT_TRUE(together.finish().ok());
  for (const RollingOdometry::Pose& pose : poses_of(single, units)) {
    const std::optional<RollingOdometry::Pose> expected = together.take();
    ASSERT_TRUE(expected);
    EXPECT_EQ(pose.pose.position_W_m, expected->pose.position_W_m);
  }
  EXPECT_FALSE(together.take());
}

TEST(RollingOdometryUnits, AClockThatStepsBackRestartsAllUnitsTogether) {
  const std::vector<std::vector<ImuSample>> units = three_units();
  RollingOdometry odometry(params_of(kPositions));
  constexpr std::size_t kStep = 600;
  constexpr TimeNs kBack_ns = 5'000'000'000;
  std::size_t refused = 0;
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    for (std::size_t unit = 0; unit < units.size(); ++unit) {
      ImuSample sample = units[unit][k];
      if (k >= kStep) sample.time_ns -= kBack_ns;
      refused += odometry.add_imu(unit, sample).ok() ? 0u : 1u;
    }
  }
  EXPECT_EQ(odometry.restart_count(), 1u);
  EXPECT_NEAR(double(refused), 3.0 * 50.0, 6.0) << "0.2 s at 250 Hz";
  ASSERT_TRUE(odometry.newest());
  EXPECT_EQ(odometry.newest()->pose.time_ns, units[0].back().time_ns - kBack_ns);
}

TEST(RollingOdometryUnits, WithTheWholeRecordingAllPosesComeAtTheEnd) {
  RollingOdometry::Params params = params_of(kPositions);
  params.lag_s = RollingOdometry::kWholeRecording;
  RollingOdometry odometry(params);
  const std::vector<std::vector<ImuSample>> units = three_units();
  for (const auto& [unit, sample] : in_time_order(units)) ASSERT_TRUE(odometry.add_imu(unit, sample).ok());
  EXPECT_FALSE(odometry.newest());
  EXPECT_FALSE(odometry.take());
  ASSERT_TRUE(odometry.finish().ok());
  std::vector<RollingOdometry::Pose> poses;
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) poses.push_back(*pose);
  ASSERT_EQ(poses.size(), units[0].size());
  EXPECT_NEAR(poses.back().pose.position_W_m.x(), kPathLength_m, 0.005 * kPathLength_m);
  const auto middle = poses[poses.size() / 2];
  EXPECT_GT(middle.angular_velocity_B_rad_s.y(), 1.0) << "the sphere turns about +y";
}

TEST(RollingOdometryUnits, LiveAndLaggedPosesDoNotDependOnLaterReadings) {
  for (const double lag_s : {0.0, 0.5}) {
    RollingOdometry::Params params = params_of(kPositions);
    params.lag_s = lag_s;
    std::vector<std::vector<ImuSample>> units = three_units();
    const std::size_t cut = units[0].size() / 2;
    RollingOdometry whole(params);
    for (std::size_t k = cut; k < units[1].size(); ++k) units[1][k] = units[1][cut];  // a unit freezes at the cut
    for (std::size_t k = cut; k < units[1].size(); ++k) units[1][k].time_ns = units[0][k].time_ns;
    const std::vector<RollingOdometry::Pose> all = poses_of(whole, units);
    for (auto& unit : units) unit.resize(cut);
    RollingOdometry part(params);
    std::vector<RollingOdometry::Pose> before;
    for (const auto& [unit, sample] : in_time_order(units)) {
      ASSERT_TRUE(part.add_imu(unit, sample).ok());
      while (const std::optional<RollingOdometry::Pose> pose = part.take()) before.push_back(*pose);
    }
    ASSERT_GT(before.size(), cut / 2) << lag_s;
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(before[k].pose.position_W_m, all[k].pose.position_W_m);
      EXPECT_EQ(before[k].pose.covariance, all[k].pose.covariance);
    }
  }
}

TEST(RollingOdometryUnits, AUnitThatDoesNotExistIsRejected) {
  RollingOdometry odometry(params_of({kPositions[0]}));
  EXPECT_EQ(odometry.add_imu(1, unit_at(kPositions[0]).front()).error_code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace tumble
