// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/turning_sense.hpp"

#include "tests/scenarios/methods/synthetic_recording.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

using Changed = std::function<Quaterniond(const Quaterniond&)>;

/// The motion is slow enough for the gyro, and its axis is no axis of a sensor.
const testing::SyntheticMotion kMotion{.angle_rad = 6.0};

/// Returns the rig's sensors, with the lidar turned against the IMU by 40 deg.
sim::Sensors sensors() {
  sim::Sensors out = testing::synthetic_rig(kMotion).sensors;
  out.lidars.front().T_BL.linear() =
      out.imus.front().T_BI.linear() * so3::exp(0.7 * Vector3d(0.6, -0.8, 0.0)).toRotationMatrix();
  return out;
}

/// Returns the true attitudes of a sensor at 20 Hz, each as `changed` writes it.
Estimate attitudes(const Matrix3d& R_BA, Frame stated, const Changed& changed) {
  Estimate out;
  out.frame = stated;
  for (int k = 0; k < 110; ++k) {
    const double time_s = 0.05 * k + 0.2;
    out.attitudes.push_back({std::llround(1e9 * time_s), changed(kMotion.attitude(time_s) * Quaterniond(R_BA)), {}});
  }
  return out;
}

Quaterniond as_is(const Quaterniond& q) {
  return q;
}
Quaterniond with_w_first(const Quaterniond& q) {
  return {q.z(), q.w(), q.x(), q.y()};  // w x y z, interpreted as x y z w
}
Quaterniond inverse(const Quaterniond& q) {
  return q.conjugate();
}

class TurningSense : public ::testing::TestWithParam<Frame> {
 protected:
  const sim::Sensors sensors_ = sensors();
  Matrix3d R_BA(Frame frame) const {
    if (frame == Frame::body) return Eigen::Matrix3d::Identity();
    return frame == Frame::imu ? sensors_.imus.front().T_BI.linear() : sensors_.lidars.front().T_BL.linear();
  }
  std::string complaint(const Changed& changed) const {
    return turning_complaint(attitudes(R_BA(GetParam()), GetParam(), changed), sensors_);
  }
};

TEST_P(TurningSense, WFirstAndInverseAreNamed) {
  EXPECT_EQ(complaint(as_is), "");
  EXPECT_THAT(complaint(with_w_first),
              HasSubstr("if the quaternions were stored with w first (expected order: x y z w)"));
  EXPECT_THAT(complaint(inverse), HasSubstr("if the quaternions described the world in sensor axes"));
}

TEST_P(TurningSense, WhatIsOnlyWrongIsNotComplainedOf) {
  EXPECT_EQ(complaint([](const Quaterniond&) { return Eigen::Quaterniond::Identity(); }), "");
  Quaterniond walked = Eigen::Quaterniond::Identity();
  EXPECT_EQ(complaint([&](const Quaterniond&) {
              walked = walked * so3::exp({0.2, -0.1, 0.15});
              return walked;
            }),
            "");
}

INSTANTIATE_TEST_SUITE_P(Frames, TurningSense, ::testing::Values(Frame::imu, Frame::lidar, Frame::body),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

TEST_P(TurningSense, AConstantDelayIsNamed) {
  const auto delayed_by = [&](double late_s) {
    Estimate late = attitudes(R_BA(GetParam()), GetParam(), as_is);
    for (AttitudeState& each : late.attitudes) each.time_ns += std::llround(1e9 * late_s);
    return clock_complaint(late, sensors_);
  };
  EXPECT_THAT(delayed_by(0.4),
              HasSubstr("the time stamps of the poses are 0.400 s too late, but at most 0.15 s is accepted; subtract"));
  EXPECT_THAT(delayed_by(-0.4), HasSubstr("the time stamps of the poses are 0.400 s too early"));
  EXPECT_EQ(delayed_by(0.1), "") << "stamps at the end of a sweep";
  EXPECT_EQ(delayed_by(0.0), "");
}

TEST(TurningSense, AnotherFrameIsNamed) {
  const sim::Sensors rig = sensors();
  const Estimate lidar = attitudes(rig.lidars.front().T_BL.linear(), Frame::imu, as_is);
  EXPECT_THAT(turning_complaint(lidar, rig), HasSubstr("(frame imu) differ from the rotations of the gyro by"));
  EXPECT_THAT(turning_complaint(lidar, rig), HasSubstr("if the poses belonged to the frame lidar"));
}

TEST(TurningSense, PosesAreCheckedToo) {
  const sim::Sensors rig = sensors();
  Estimate estimate;
  for (const AttitudeState& each : attitudes(rig.imus.front().T_BI.linear(), Frame::imu, with_w_first).attitudes) {
    PoseState pose;
    pose.time_ns = each.time_ns;
    pose.orientation_W = each.orientation_W;
    estimate.poses.push_back(pose);
  }
  EXPECT_THAT(turning_complaint(estimate, rig), HasSubstr("w first"));
  estimate.poses.resize(6);
  EXPECT_EQ(turning_complaint(estimate, rig), "") << "six poses, five pairs, show nothing";
}

}  // namespace
}  // namespace tumble::scenarios
