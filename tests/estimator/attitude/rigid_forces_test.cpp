// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/src/attitude/rigid_forces.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

const Eigen::Vector3d kBegins_rad_s2(4.0, -7.0, 90.0);

/// Returns three IMUs of a rotating sphere whose acceleration, according to the rates, differs from its present one.
RigidBodyImuForces sphere() {
  RigidBodyImuForces rigid;
  const std::array<Eigen::Vector3d, 3> places = {{{0.09, 0.02, 0.01}, {-0.05, 0.08, -0.02}, {-0.04, -0.07, 0.03}}};
  rigid.rate_rad_s = {1.0, 5.0, 3.0};
  rigid.acceleration_rad_s2 = {2.0, 1.0, 5.0};
  const Eigen::Vector3d true_acceleration = rigid.acceleration_rad_s2 + kBegins_rad_s2;
  for (std::size_t k = 0; k < places.size(); ++k) {
    rigid.imu_present[k] = true;
    rigid.position_m[k] = places[k];
    rigid.force_m_s2[k] = Eigen::Vector3d(-9.0, 1.0, 0.5) + true_acceleration.cross(places[k]) +
                          rigid.rate_rad_s.cross(rigid.rate_rad_s.cross(places[k]));
    rigid.peak_m_s2[k] = 14.0;
    rigid.force_change_m_s2[k] = 1.0 + static_cast<double>(k);
  }
  rigid.unsaturated_peak_max_m_s2 = 12.0;
  rigid.tolerated_saturation_m_s2 = 3.0;
  return rigid;
}

/// Returns how many IMUs agree with the reference after a new acceleration is estimated.
int agree_after_asking(RigidBodyImuForces rigid) {
  rigid.acceleration_rad_s2 += rigid.mean_imu_acceleration();
  return rigid.largest_agreeing_set().agreeing_imu_count;
}

// imu_merge.md (I7): exact if nothing is saturated.
TEST(RigidBodyImuForces, AnAccelerationThatBeganIsFoundFromTheDifferences) {
  const RigidBodyImuForces rigid = sphere();
  EXPECT_EQ(rigid.largest_agreeing_set().agreeing_imu_count, 0);
  EXPECT_LT((rigid.mean_imu_acceleration() - kBegins_rad_s2).norm(), 1e-9);
  EXPECT_EQ(agree_after_asking(rigid), 2);
}

// Negative control: forces that two IMUs hide are no acceleration.
TEST(RigidBodyImuForces, WhatTwoUnitsHideIsNoAcceleration) {
  RigidBodyImuForces rigid = sphere();
  rigid.force_m_s2[0] += Eigen::Vector3d(25.0, 3.0, 0.0);
  rigid.force_m_s2[1] += Eigen::Vector3d(-4.0, 18.0, 9.0);
  EXPECT_EQ(rigid.largest_agreeing_set().agreeing_imu_count, 0);
  EXPECT_LT(agree_after_asking(rigid), 2);
}

// The other IMUs agree without a new acceleration.
TEST(RigidBodyImuForces, OfOneThatHidesTheOthersAgree) {
  RigidBodyImuForces rigid = sphere();
  rigid.acceleration_rad_s2 += kBegins_rad_s2;
  rigid.force_m_s2[2] += Eigen::Vector3d(0.0, 0.0, 8.0);
  const RigidBodyImuForces::AgreeingImuForces believed = rigid.largest_agreeing_set();
  EXPECT_EQ(believed.agreeing_imu_count, 1);
  EXPECT_EQ(believed.imu, 0U);
  EXPECT_FALSE(rigid.forces_agree(2, 0));
}

TEST(RigidBodyImuForces, UnitsInALineGiveWhatTheyCan) {
  RigidBodyImuForces rigid = sphere();
  for (std::size_t k = 0; k < 3; ++k) {
    rigid.position_m[k] = Eigen::Vector3d(0.05 * static_cast<double>(k) - 0.05, 0.0, 0.0);
    rigid.force_m_s2[k] = (rigid.acceleration_rad_s2 + kBegins_rad_s2).cross(rigid.position_m[k]) +
                          rigid.rate_rad_s.cross(rigid.rate_rad_s.cross(rigid.position_m[k]));
  }
  const Eigen::Vector3d found = rigid.mean_imu_acceleration();
  EXPECT_NEAR(found.x(), 0.0, 1e-9) << "about the line: unknown";
  EXPECT_LT((found - kBegins_rad_s2).tail<2>().norm(), 1e-9);
}

}  // namespace
}  // namespace tumble
