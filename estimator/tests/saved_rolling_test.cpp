// SPDX-License-Identifier: BSD-3-Clause
// As saved_tumbling_test.cpp, of a sphere.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "rolled_sphere.hpp"

namespace tumble {
namespace {

using test::kPositions, test::params_of, test::unit_at;

using Poses = std::vector<RollingOdometry::Pose>;

struct Sphere {
  RollingOdometry::Params params;
  std::vector<std::vector<ImuSample>> units;
};

/// A sphere whose gyros clip in the fastest part of the motion, without samples for half a second.
Sphere three_units(double lag_s) {
  Sphere out;
  out.params = params_of(kPositions);
  out.params.lag_s = lag_s;
  for (RollingOdometry::Unit& unit : out.params.units) unit.sheet.gyro_range_rad_s = 10.0;
  for (const Eigen::Vector3d& position_m : kPositions) {
    std::vector<ImuSample>& samples = out.units.emplace_back(unit_at(position_m));
    std::erase_if(samples, [](const ImuSample& s) { return s.time_ns > 2'700'000'000 && s.time_ns < 3'200'000'000; });
    for (ImuSample& sample : samples) {
      double& rate = sample.angular_velocity_rad_s.y();
      if (rate > 10.0) sample.device_clip_flags = kClipGyroY;
      rate = std::min(rate, 10.0);
    }
  }
  return out;
}

void feed_units(const Sphere& sphere, std::size_t from, std::size_t to, RollingOdometry& odometry, Poses& poses) {
  for (std::size_t k = from; k < to; ++k) {
    std::vector<ImuSample> now;
    for (const std::vector<ImuSample>& unit : sphere.units) now.push_back(unit[k]);
    const Status status = odometry.add_imus(now);
    ASSERT_TRUE(status.ok()) << status.message();
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) poses.push_back(*pose);
  }
}

void finish_rolling(RollingOdometry& odometry, Poses& poses) {
  odometry.finish();
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) poses.push_back(*pose);
}

void expect_rolling_splits(const Sphere& sphere, const std::vector<std::size_t>& splits) {
  const std::size_t count = sphere.units[0].size();
  RollingOdometry whole(sphere.params);
  Poses expected;
  std::vector<std::vector<std::byte>> saved;
  std::size_t k = 0;
  for (const std::size_t split : splits) {
    feed_units(sphere, k, split, whole, expected);
    saved.push_back(whole.save());
    k = split;
  }
  feed_units(sphere, k, count, whole, expected);
  finish_rolling(whole, expected);
  for (std::size_t i = 0; i < splits.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "split at " << splits[i]);
    RollingOdometry rebooted(sphere.params);
    const Status status = rebooted.load(saved[i]);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(rebooted.save(), saved[i]);
    Poses late;
    feed_units(sphere, splits[i], count, rebooted, late);
    finish_rolling(rebooted, late);
    ASSERT_LE(late.size(), expected.size());
    for (std::size_t p = 0; p < late.size(); ++p) {
      const RollingOdometry::Pose &a = expected[expected.size() - late.size() + p], &b = late[p];
      ASSERT_EQ(a.pose.time_ns, b.pose.time_ns);
      ASSERT_EQ(a.pose.p_WA_m, b.pose.p_WA_m);
      ASSERT_EQ(a.pose.q_WA.coeffs(), b.pose.q_WA.coeffs());
      ASSERT_EQ(a.pose.covariance, b.pose.covariance);
      ASSERT_EQ(a.mode, b.mode);
    }
    EXPECT_TRUE(rebooted.units() == whole.units());
    EXPECT_EQ(rebooted.save(), whole.save());
  }
}

// sample 674 is the last before the gap, which nodes of the way back still lie in half a second later
const std::vector<std::size_t> kSplits = {1, 200, 600, 674, 675, 676, 760, 800};

TEST(SavedRollingOdometry, GoesOnFromAnywhereWithALag) {
  expect_rolling_splits(three_units(0.3), kSplits);
}

TEST(SavedRollingOdometry, GoesOnFromAnywhereLive) {
  expect_rolling_splits(three_units(0.0), {1, 200, 600, 675, 800});
}

TEST(SavedRollingOdometry, PosesThatNobodyTookAndAnEndAreKept) {
  const Sphere sphere = three_units(0.3);
  RollingOdometry one(sphere.params), other(sphere.params);
  for (std::size_t k = 0; k < 400; ++k)
    ASSERT_TRUE(one.add_imus(std::vector{sphere.units[0][k], sphere.units[1][k], sphere.units[2][k]}).ok());
  ASSERT_TRUE(one.take());
  one.finish();
  ASSERT_TRUE(other.load(one.save()).ok());
  while (const std::optional<RollingOdometry::Pose> pose = one.take()) {
    const std::optional<RollingOdometry::Pose> same = other.take();
    ASSERT_TRUE(same);
    EXPECT_EQ(pose->pose.time_ns, same->pose.time_ns);
  }
  EXPECT_FALSE(other.take());
  EXPECT_EQ(other.add_imus(std::vector{sphere.units[0][401], sphere.units[1][401], sphere.units[2][401]}).error_code,
            ErrorCode::out_of_range)
      << "the run has ended";
}

// As the splits, the end may lie where a node of the way back lies within a gap.
TEST(SavedRollingOdometry, AnEndAfterAGapIsKept) {
  const Sphere sphere = three_units(0.3);
  for (const std::size_t end : {674u, 675u, 676u, 700u, 740u, 760u, 780u}) {
    RollingOdometry one(sphere.params), other(sphere.params);
    Poses expected, same;
    feed_units(sphere, 0, end, one, expected);
    finish_rolling(one, expected);
    const Status status = other.load(one.save());
    ASSERT_TRUE(status.ok()) << end << ": " << status.message();
    EXPECT_EQ(other.save(), one.save()) << end;
  }
}

TEST(SavedRollingOdometry, OtherParametersAreNamed) {
  const RollingOdometry::Params params = params_of(kPositions);
  const std::vector<std::byte> saved = RollingOdometry(params).save();
  const auto refusal = [&](const RollingOdometry::Params& other) {
    const Status status = RollingOdometry(other).load(saved);
    EXPECT_FALSE(status.ok());
    return std::string(status.field);
  };
  RollingOdometry::Params other = params;
  other.radius_m = 0.15;
  EXPECT_EQ(refusal(other), "radius_m");
  other = params;
  other.units.pop_back();
  EXPECT_EQ(refusal(other), "units");
  other = params;
  other.units[1].T_BI.translation().x() += 1e-3;
  EXPECT_EQ(refusal(other), "T_BI");
  other = params;
  other.units[2].sheet.rate_hz = 200.0;
  EXPECT_EQ(refusal(other), "rate_hz");
  other = params;
  other.expert.rolling.filter.q_WI_start = Eigen::Quaterniond::Identity();
  EXPECT_EQ(refusal(other), "q_WI_start");
  other = params;
  other.expert.merge.gyro_elements[0].slope_sigma.x() = 0.01;
  EXPECT_EQ(refusal(other), "elements.slope_sigma");
}

}  // namespace
}  // namespace tumble
