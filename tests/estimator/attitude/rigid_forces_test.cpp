// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/src/attitude/rigid_forces.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tumble {
namespace {

const Eigen::Vector3d kBegins_rad_s2(4.0, -7.0, 90.0);

/// Three IMUs of a rotating sphere whose acceleration differs from the acceleration that the rates indicate.
RigidForces sphere() {
  RigidForces rigid;
  const std::array<Eigen::Vector3d, 3> places = {{{0.09, 0.02, 0.01}, {-0.05, 0.08, -0.02}, {-0.04, -0.07, 0.03}}};
  rigid.rate_rad_s = {1.0, 5.0, 3.0};
  rigid.acceleration_rad_s2 = {2.0, 1.0, 5.0};
  const Eigen::Vector3d true_acceleration = rigid.acceleration_rad_s2 + kBegins_rad_s2;
  for (std::size_t k = 0; k < places.size(); ++k) {
    rigid.present[k] = true;
    rigid.position_m[k] = places[k];
    rigid.force_m_s2[k] = Eigen::Vector3d(-9.0, 1.0, 0.5) + true_acceleration.cross(places[k]) +
                          rigid.rate_rad_s.cross(rigid.rate_rad_s.cross(places[k]));
    rigid.peak_m_s2[k] = 14.0;
    rigid.change_m_s2[k] = 1.0 + static_cast<double>(k);
  }
  rigid.small_peak_m_s2 = 12.0;
  rigid.hidden_force_m_s2 = 3.0;
  return rigid;
}

/// Returns how many IMUs agree with the reference IMU if the new acceleration is estimated.
int agree_after_asking(RigidForces rigid) {
  rigid.acceleration_rad_s2 += rigid.common_acceleration();
  return rigid.most_agreed().others;
}

// imu_merge.md (I7): exact without clipped readings.
TEST(RigidForces, AnAccelerationThatBeganIsFoundFromTheDifferences) {
  const RigidForces rigid = sphere();
  EXPECT_EQ(rigid.most_agreed().others, 0);
  EXPECT_LT((rigid.common_acceleration() - kBegins_rad_s2).norm(), 1e-9);
  EXPECT_EQ(agree_after_asking(rigid), 2);
}

// Negative control: if two IMUs are clipped, no acceleration is estimated.
TEST(RigidForces, WhatTwoUnitsHideIsNoAcceleration) {
  RigidForces rigid = sphere();
  rigid.force_m_s2[0] += Eigen::Vector3d(25.0, 3.0, 0.0);
  rigid.force_m_s2[1] += Eigen::Vector3d(-4.0, 18.0, 9.0);
  EXPECT_EQ(rigid.most_agreed().others, 0);
  EXPECT_LT(agree_after_asking(rigid), 2);
}

// If one IMU is clipped, the others determine its force directly.
TEST(RigidForces, OfOneThatHidesTheOthersAgree) {
  RigidForces rigid = sphere();
  rigid.acceleration_rad_s2 += kBegins_rad_s2;
  rigid.force_m_s2[2] += Eigen::Vector3d(0.0, 0.0, 8.0);
  const RigidForces::AgreeingForces believed = rigid.most_agreed();
  EXPECT_EQ(believed.others, 1);
  EXPECT_EQ(believed.unit, 0U);
  EXPECT_FALSE(rigid.agree(2, 0));
}

TEST(RigidForces, UnitsInALineGiveWhatTheyCan) {
  RigidForces rigid = sphere();
  for (std::size_t k = 0; k < 3; ++k) {
    rigid.position_m[k] = Eigen::Vector3d(0.05 * static_cast<double>(k) - 0.05, 0.0, 0.0);
    rigid.force_m_s2[k] = (rigid.acceleration_rad_s2 + kBegins_rad_s2).cross(rigid.position_m[k]) +
                          rigid.rate_rad_s.cross(rigid.rate_rad_s.cross(rigid.position_m[k]));
  }
  const Eigen::Vector3d found = rigid.common_acceleration();
  EXPECT_NEAR(found.x(), 0.0, 1e-9) << "about the line: unknown";
  EXPECT_LT((found - kBegins_rad_s2).tail<2>().norm(), 1e-9);
}

}  // namespace
}  // namespace tumble
