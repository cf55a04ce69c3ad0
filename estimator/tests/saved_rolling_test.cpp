// SPDX-License-Identifier: BSD-3-Clause
// As saved_tumbling_test.cpp, of a sphere.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "damaged_bytes.hpp"
#include "rolled_sphere.hpp"

namespace tumble {
namespace {

using test::Bytes, test::kPositions, test::unit_at;

constexpr std::size_t kAtRest = 900, kMidway = 620;   // samples; the sphere rests again from sample 875 on
const Eigen::Vector3d kCentre_m(0.004, 0.0, -0.003);  // error of the stated centre

RollingOdometry::Params params_off_centre(double lag_s) {
  RollingOdometry::Params params = test::params_of(kPositions);
  params.lag_s = lag_s;
  for (RollingOdometry::ImuSetup& unit : params.imus) unit.T_BI.translation() += kCentre_m;
  return params;
}

/// Returns the samples of three IMUs. If `clips` is true, the gyros clip at 10 rad/s without a flag.
std::vector<std::vector<ImuSample>> three_imus(bool clips) {
  std::vector<std::vector<ImuSample>> out;
  for (const Eigen::Vector3d& position_m : kPositions) {
    for (ImuSample& sample : out.emplace_back(unit_at(position_m))) {
      if (clips) sample.angular_velocity_rad_s.y() = std::min(sample.angular_velocity_rad_s.y(), 10.0);
    }
  }
  return out;
}

void feed_units(std::size_t from, std::size_t to, RollingOdometry& odometry, bool clips = false, TimeNs later_ns = 0) {
  const std::vector<std::vector<ImuSample>> units = three_imus(clips);
  for (std::size_t k = from; k < to; ++k) {
    std::vector<ImuSample> now;
    for (const std::vector<ImuSample>& unit : units) {
      now.push_back(unit[k]);
      now.back().time_ns += later_ns;
    }
    const Status status = odometry.add_imus(now);
    ASSERT_TRUE(status.ok()) << status.message();
    while (odometry.take()) continue;
  }
}

RollingOdometry run_until(double lag_s, std::size_t to = kAtRest, bool clips = false) {
  RollingOdometry out(params_off_centre(lag_s));
  feed_units(0, to, out, clips);
  return out;
}

TEST(SavedRollingOdometry, ContinuesAtTheSavedPoseWithTheCalibration) {
  for (const double lag_s : {0.0, 0.3}) {
    SCOPED_TRACE(lag_s);
    const RollingOdometry before = run_until(lag_s);
    RollingOdometry rebooted(params_off_centre(lag_s)), fresh(params_off_centre(lag_s));
    std::optional<PoseState> last;
    const Status status = rebooted.load(before.save(), &last);
    ASSERT_TRUE(status.ok()) << status.message();
    ASSERT_TRUE(last);
    EXPECT_GT(last->time_ns, 3'500'000'000);
    EXPECT_NEAR(last->position_W_m.x(), test::kPathLength_m, 0.02 * test::kPathLength_m);

    const std::size_t count = three_imus(false)[0].size();
    feed_units(kAtRest, kAtRest + 10, rebooted);
    feed_units(kAtRest, kAtRest + 10, fresh);
    const RollingOdometry::Pose pose = *rebooted.newest();
    EXPECT_LT((pose.pose.position_W_m - last->position_W_m).norm(), 2e-3);
    EXPECT_LT(fresh.newest()->pose.position_W_m.norm(), 2e-3) << "negative control: without load()";
    EXPECT_TRUE(pose.position_uncertain);
    EXPECT_GE(pose.pose.covariance(0, 0), last->covariance(0, 0));
    const RollingOdometry::SphereCalibration found = before.sphere_calibration(), kept = rebooted.sphere_calibration();
    EXPECT_LT((found.sphere_centre_B_m - kCentre_m).norm(), 0.5 * kCentre_m.norm()) << "else the run estimated nothing";
    EXPECT_LT((kept.sphere_centre_B_m - found.sphere_centre_B_m).norm(), 0.2 * kCentre_m.norm());
    EXPECT_LT(fresh.sphere_calibration().sphere_centre_B_m.norm(), 0.2 * kCentre_m.norm()) << "negative control";
    // rolls the same path again
    feed_units(kAtRest + 10, count, rebooted);
    const TimeNs later_ns = three_imus(false)[0].back().time_ns;
    feed_units(0, count, rebooted, false, later_ns);
    EXPECT_NEAR(rebooted.newest()->pose.position_W_m.x() - last->position_W_m.x(), test::kPathLength_m,
                0.02 * test::kPathLength_m);
  }
}

/// The saturation limits of the IMUs are at the end of the bytes.
TEST(SavedRollingOdometry, KeepsSaturationLimits) {
  const Bytes saved = run_until(0.0, kAtRest, true).save(), unsaturated = run_until(0.0).save();
  const auto limits = [](const Bytes& bytes) {
    constexpr std::size_t kUnits = 3 * (6 * sizeof(double) + 6);  // without planes
    return Bytes(bytes.end() - kUnits, bytes.end());
  };
  RollingOdometry rebooted(params_off_centre(0.0));
  ASSERT_TRUE(rebooted.load(saved).ok());
  EXPECT_EQ(limits(rebooted.save()), limits(saved));
  EXPECT_NE(limits(unsaturated), limits(saved)) << "else the run detected nothing";
  rebooted.reset();
  EXPECT_EQ(limits(rebooted.save()), limits(saved));
}

TEST(SavedRollingOdometry, IsSavedAtAnyStage) {
  for (const double lag_s : {0.0, 0.3, RollingOdometry::kWholeRecording}) {
    for (const std::size_t to : {std::size_t{0}, std::size_t{1}, std::size_t{30}, kMidway}) {
      for (const bool ends : {false, true}) {
        RollingOdometry odometry = run_until(lag_s, to), other(params_off_centre(lag_s));
        if (ends) (void)odometry.finish();
        const Status status = other.load(odometry.save());
        EXPECT_TRUE(status.ok()) << lag_s << ", " << to << ": " << status.message();
      }
    }
  }
}

TEST(SavedRollingOdometry, DamagedBytesAreRefused) {
  const RollingOdometry odometry = run_until(0.1, kMidway);
  test::expect_damage_is_refused(odometry.save(), odometry);
}

TEST(SavedRollingOdometry, AnotherSphereIsRefused) {
  const RollingOdometry::Params params = params_off_centre(0.1);
  const Bytes saved = RollingOdometry(params).save();
  const auto refusal = [&](const RollingOdometry::Params& other) {
    return std::string(RollingOdometry(other).load(saved).field);
  };
  EXPECT_EQ(refusal(params), "") << "negative control";
  RollingOdometry::Params other = params;
  other.radius_m = 0.15;
  EXPECT_EQ(refusal(other), "radius_m");
  other = params;
  other.imus.pop_back();
  EXPECT_EQ(refusal(other), "units");
  other = params;
  other.imus[1].T_BI.translation().x() += 1e-3;
  EXPECT_EQ(refusal(other), "lever_arm_m");
  other = params;  // parameters of the estimation may change
  other.lag_s = 0.2;
  EXPECT_EQ(refusal(other), "");
}

}  // namespace
}  // namespace tumble
