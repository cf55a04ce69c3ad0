// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "live_readings.hpp"
#include "rolled_sphere.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::kPositions, test::kRadius_m, test::kPathLength_m, test::params_of, test::unit_at;

TEST(RollingOdometry, RollsTwoTurnsWithOneUnitOrThree) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    const std::vector<Eigen::Vector3d> positions_m(kPositions.begin(),
                                                   kPositions.begin() + static_cast<std::ptrdiff_t>(count));
    std::vector<std::vector<ImuSample>> units;
    for (const Eigen::Vector3d& position_m : positions_m) units.push_back(unit_at(position_m));
    RollingOdometry odometry(params_of(positions_m));
    EXPECT_FALSE(odometry.newest());
    std::vector<RollingOdometry::Pose> poses;
    for (std::size_t k = 0; k < units[0].size(); ++k) {
      std::vector<ImuSample> now;
      for (const auto& unit : units) now.push_back(unit[k]);
      ASSERT_TRUE(odometry.add_imus(now).ok());
      while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) poses.push_back(*pose);
    }
    ASSERT_TRUE(odometry.newest());
    EXPECT_NEAR(odometry.newest()->pose.position_W_m.x(), kPathLength_m, 0.01 * kPathLength_m) << count;
    EXPECT_TRUE(odometry.newest()->at_rest);
    const std::size_t before = poses.size();
    odometry.finish();
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) poses.push_back(*pose);
    EXPECT_GT(poses.size(), before);  // finish() adds the poses within the lag
    EXPECT_EQ(poses.size(), units[0].size());
    EXPECT_NEAR(poses.back().pose.position_W_m.x(), kPathLength_m, 0.005 * kPathLength_m);
    EXPECT_LT(poses.back().pose.position_W_m.tail<2>().norm(), 0.01);
  }
}

TEST(RollingOdometry, AnotherRadiusEndsElsewhere) {  // negative control
  RollingOdometry::Params params = params_of({kPositions[0]});
  params.radius_m = 1.1 * kRadius_m;
  RollingOdometry odometry(params);
  for (const ImuSample& sample : unit_at(kPositions[0])) ASSERT_TRUE(odometry.add_imu(sample).ok());
  EXPECT_GT(std::abs(odometry.newest()->pose.position_W_m.x() - kPathLength_m), 0.05 * kPathLength_m);
}

TEST(RollingOdometry, WithoutALagEachLivePoseIsGivenOnce) {
  RollingOdometry::Params params = params_of({kPositions[0]});
  params.lag_s = 0.0;
  RollingOdometry odometry(params);
  std::size_t given = 0;
  const std::vector<ImuSample> samples = unit_at(kPositions[0]);
  for (const ImuSample& sample : samples) {
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) {
      ++given;
      EXPECT_EQ(pose->pose.time_ns, sample.time_ns);
      EXPECT_EQ(pose->pose.position_W_m, odometry.newest()->pose.position_W_m);
    }
  }
  EXPECT_EQ(given, samples.size());
}

TEST(RollingOdometry, ACopyGoesOnWithTheSameBits) {
  const std::vector<ImuSample> samples = unit_at(kPositions[0]);
  RollingOdometry whole(params_of({kPositions[0]}));
  for (const ImuSample& sample : samples) ASSERT_TRUE(whole.add_imu(sample).ok());
  RollingOdometry first(params_of({kPositions[0]}));
  const std::size_t split = samples.size() / 2 + 7;
  for (std::size_t k = 0; k < split; ++k) ASSERT_TRUE(first.add_imu(samples[k]).ok());
  RollingOdometry second(first);
  for (std::size_t k = split; k < samples.size(); ++k) ASSERT_TRUE(second.add_imu(samples[k]).ok());
  EXPECT_EQ(second.newest()->pose.position_W_m, whole.newest()->pose.position_W_m);
  EXPECT_EQ(second.newest()->pose.orientation_W.coeffs(), whole.newest()->pose.orientation_W.coeffs());
}

struct Ended {
  double off_m = 0.0, sigma_m = 0.0;
};

/// Returns the end of two turns in which the gyros clip at 8 rad/s without a flag, at rates of up to 11.8 rad/s.
Ended end_of_clipped(std::size_t count, double stated_rad_s) {
  const std::vector<Eigen::Vector3d> positions_m(kPositions.begin(),
                                                 kPositions.begin() + static_cast<std::ptrdiff_t>(count));
  RollingOdometry::Params params = params_of(positions_m);
  std::vector<std::vector<ImuSample>> units;
  for (std::size_t k = 0; k < count; ++k) {
    params.imus[k].data_sheet.gyro_range_rad_s = stated_rad_s;
    units.push_back(unit_at(positions_m[k]));
    for (ImuSample& sample : units[k])
      sample.angular_velocity_rad_s = sample.angular_velocity_rad_s.cwiseMin(8.0).cwiseMax(-8.0);
  }
  RollingOdometry odometry(params);
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    std::vector<ImuSample> now;
    for (const auto& unit : units) now.push_back(unit[k]);
    EXPECT_TRUE(odometry.add_imus(now).ok());
  }
  const RollingOdometry::Pose end = *odometry.newest();
  return {std::abs(end.pose.position_W_m.x() - kPathLength_m), std::sqrt(end.pose.covariance(0, 0))};
}

TEST(RollingOdometry, ARailThatNoFlagTellsIsSeenByTheReadings) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    const Ended seen = end_of_clipped(count, 9.0);
    // negative control: with a much larger stated range, equal readings do not count as saturated
    const Ended accepted = end_of_clipped(count, 30.0);
    // Measured error and sigma [m] with one IMU: 0.454 and 0.290, in the control 5.170 and 0.021. With three IMUs:
    // 0.218 and 0.099, in the control 4.105 and 0.067.
    EXPECT_LT(seen.off_m, 3.0 * seen.sigma_m) << count;
    EXPECT_LT(seen.off_m, 0.15 * accepted.off_m) << count;
    EXPECT_GT(accepted.off_m, 3.0 * accepted.sigma_m) << count;
  }
}

/// Freezes axis y of the gyro, about which the sphere rolls, when the sphere begins to turn.
std::vector<ImuSample> frozen_y(std::vector<ImuSample> unit) {
  const std::size_t from = unit.size() / 3;
  for (std::size_t k = from; k < unit.size(); ++k)
    unit[k].angular_velocity_rad_s.y() = unit[from].angular_velocity_rad_s.y();
  for (std::size_t k = from; k < unit.size(); ++k)
    unit[k].angular_velocity_rad_s.x() += 0.5 * std::sin(0.05 * double(k));
  return unit;
}

TEST(RollingOdometry, AUnitOfWhichAnAxisFreezesIsLeftOutAndNamed) {
  const std::vector<Eigen::Vector3d> positions_m(kPositions.begin(), kPositions.end());
  std::vector<std::vector<ImuSample>> units;
  for (const Eigen::Vector3d& position_m : positions_m) units.push_back(test::noisy(unit_at(position_m)));
  RollingOdometry sound(params_of(positions_m)), harmed(params_of(positions_m));
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    ASSERT_TRUE(sound.add_imus(std::vector<ImuSample>{units[0][k], units[1][k], units[2][k]}).ok());
    EXPECT_TRUE(sound.health().ok()) << sound.health().worst_message();
  }
  units[1] = frozen_y(units[1]);
  for (std::size_t k = 0; k < units[0].size(); ++k)
    ASSERT_TRUE(harmed.add_imus(std::vector<ImuSample>{units[0][k], units[1][k], units[2][k]}).ok());
  ASSERT_FALSE(harmed.health().ok());
  const HealthFinding found = harmed.health().findings.front();
  EXPECT_EQ(found.kind, HealthFinding::Kind::imu_frozen);
  EXPECT_EQ(found.sensor, "imu_2");
  EXPECT_STREQ(found.axis, "gyro_y");
  EXPECT_FALSE(harmed.health().invalidates_estimate()) << "two IMUs remain";
  EXPECT_NEAR(sound.newest()->pose.position_W_m.x(), kPathLength_m, 0.02 * kPathLength_m);
  EXPECT_NEAR(harmed.newest()->pose.position_W_m.x(), kPathLength_m, 0.05 * kPathLength_m);
}

TEST(RollingOdometry, TheOnlyUnitIsRefusedWithTheNameOfItsFrozenAxis) {
  RollingOdometry odometry(params_of({kPositions[0]}));
  Status status;
  for (const ImuSample& sample : frozen_y(test::noisy(unit_at(kPositions[0])))) {
    if (!(status = odometry.add_imu(sample)).ok()) break;
  }
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_NE(status.message().find("gyro y"), std::string::npos) << status.message();
  EXPECT_EQ(odometry.health().worst_status().message(), status.message());
  EXPECT_EQ(odometry.health().findings.front().kind, HealthFinding::Kind::frozen_axis);
}

TEST(RollingOdometry, TroubleIsAValue) {
  RollingOdometry odometry(params_of(kPositions));
  EXPECT_EQ(odometry.add_imu(unit_at(kPositions[0])[0]).error_code, ErrorCode::insufficient_data);
  RollingOdometry one(params_of({kPositions[0]}));
  const std::vector<ImuSample> samples = unit_at(kPositions[0]);
  ASSERT_TRUE(one.add_imu(samples[5]).ok());
  EXPECT_EQ(one.add_imu(samples[4]).error_code, ErrorCode::time_order);
  ImuSample late = samples[6];
  late.time_ns += 1'100'000'000;
  EXPECT_EQ(one.add_imu(late).error_code, ErrorCode::gap);
  EXPECT_TRUE(one.add_imu(samples[6]).ok());
  one.finish();
  EXPECT_EQ(one.add_imu(samples[7]).error_code, ErrorCode::out_of_range);
  one.reset();
  EXPECT_TRUE(one.add_imu(samples[7]).ok());
  ImuSample weightless = samples[5];
  weightless.specific_force_m_s2.setZero();
  RollingOdometry fresh(params_of({kPositions[0]}));
  EXPECT_EQ(fresh.add_imu(weightless).error_code, ErrorCode::degenerate);
  for (const ImuSample& sample : samples) ASSERT_TRUE(fresh.add_imu(sample).ok());
  EXPECT_NEAR(fresh.newest()->pose.position_W_m.x(), kPathLength_m, 0.01 * kPathLength_m);
}

TEST(RollingOdometry, RefusesParametersOutOfTheirBounds) {
  RollingOdometry::Params params = params_of(kPositions);
  params.radius_m = 0.0;
  EXPECT_THROW(RollingOdometry{params}, InvalidParams);
  params = params_of(std::vector<Eigen::Vector3d>{});
  EXPECT_THROW(RollingOdometry{params}, InvalidParams);
  params = params_of(kPositions);
  params.lag_s = -1.0;
  EXPECT_THROW(RollingOdometry{params}, InvalidParams);
  params = params_of(kPositions);
  params.imus[0].T_BI.translation() = Eigen::Vector3d(0.0, 0.0, 1.01 * params.radius_m);
  EXPECT_THROW(RollingOdometry{params}, InvalidParams) << "an IMU outside of the sphere";
  params.imus[0].T_BI.translation().z() = 0.99 * params.radius_m;
  EXPECT_NO_THROW(RollingOdometry{params});
}

}  // namespace
}  // namespace tumble
