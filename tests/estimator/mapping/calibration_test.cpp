// SPDX-License-Identifier: BSD-3-Clause
// Compares the distance of a calibration from the stated one with a closed form.
#include "tumble/mapping/types.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

const LidarImuCalibrationPrior kGiven{{}, 0.01, 0.002, 0.003};

LidarImuCalibration turned(double by_rad) {
  LidarImuCalibration out;
  out.T_IL.linear() = Eigen::AngleAxisd(by_rad, Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0).toRotationMatrix();
  return out;
}

TEST(LidarImuCalibrationPrior, CountsTheLargestOfTurnShiftAndDelayInItsDeviations) {
  EXPECT_EQ(kGiven.distance_in_sigmas(LidarImuCalibration{}), 0.0);
  LidarImuCalibration learnt = turned(0.03);
  EXPECT_NEAR(kGiven.distance_in_sigmas(learnt), 3.0, 1e-9);
  learnt.T_IL.translation() = Eigen::Vector3d(0.0, -0.006, 0.008);
  EXPECT_NEAR(kGiven.distance_in_sigmas(learnt), 5.0, 1e-9);
  learnt.imu_minus_lidar_clock_s = -0.018;
  EXPECT_NEAR(kGiven.distance_in_sigmas(learnt), 6.0, 1e-9);
  learnt = {};
  learnt.gravity_W_m_s2 = Eigen::Vector3d(1.0, 0.0, -9.7);  // differs in each run
  EXPECT_EQ(kGiven.distance_in_sigmas(learnt), 0.0);
}

TEST(LidarImuCalibrationPrior, ALargeDistanceIsOutOfRange) {
  EXPECT_TRUE(check_lidar_calibration_distance(kGiven.distance_in_sigmas(turned(0.049))).ok());
  const Status wrong = check_lidar_calibration_distance(kGiven.distance_in_sigmas(turned(0.051)));
  EXPECT_EQ(wrong.error_code, ErrorCode::out_of_range);
  EXPECT_NEAR(wrong.value, 5.1, 1e-9);
  EXPECT_EQ(wrong.bound, LidarImuCalibrationPrior::kDistanceMax_sigmas);
}

TEST(LidarImuCalibrationPrior, WhatIsExactMayNotMove) {
  const LidarImuCalibrationPrior exact;
  EXPECT_EQ(exact.distance_in_sigmas(LidarImuCalibration{}), 0.0);
  EXPECT_TRUE(std::isinf(exact.distance_in_sigmas(turned(1e-6))));
}

}  // namespace
}  // namespace tumble
