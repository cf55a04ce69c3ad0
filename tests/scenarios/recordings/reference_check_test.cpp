// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kEnd_s = 12.0;
constexpr std::int64_t kStep_ns = 10'000'000;
constexpr double kUp_m_s2 = 9.81;

/// Returns the rotation from body to world: every axis rotates, at up to 1.5 rad/s, as a hand turns a sensor.
Quaterniond hand_held(double time_s) {
  return so3::exp({0.0, 0.0, 0.9 * std::sin(1.1 * time_s) + 0.3 * time_s}) *
         so3::exp({0.0, 0.6 * std::sin(1.7 * time_s + 0.4), 0.0}) * so3::exp({0.5 * std::sin(2.3 * time_s), 0.0, 0.0});
}

/// Returns the rotation of a sphere on a straight path: it turns about y alone.
Quaterniond rolling(double time_s) {
  return so3::exp({0.0, 1.2 * time_s + 0.8 * std::sin(time_s), 0.0});
}

using Motion = Quaterniond (*)(double time_s);
using Changed = Quaterniond (*)(const Quaterniond&);

Quaterniond as_is(const Quaterniond& q) {
  return q;
}
/// Returns the quaternion of a file with "qw qx qy qz" that was read as "qx qy qz qw".
Quaterniond with_w_first(const Quaterniond& q) {
  return {q.z(), q.w(), q.x(), q.y()};
}
Quaterniond inverted(const Quaterniond& q) {
  return q.conjugate();
}
Quaterniond turned(const Quaterniond& q) {
  return q * so3::exp({0.0, 0.0, 1.5});
}

/// Returns sensors with the motion: an IMU at 100 Hz, turned by 23 degrees in the body, whose rates add up exactly; and
/// a lidar of one point.
sim::Sensors sensors_of(Motion motion) {
  sim::Sensors sensors;
  sim::ImuRecord& imu = sensors.imus.emplace_back();
  imu.name = "imu";
  imu.period_ns = kStep_ns;
  imu.T_BI.linear() = so3::exp({0.2, -0.3, 0.2}).toRotationMatrix();
  const Quaterniond q_BI(imu.T_BI.linear());
  const double step_s = 1e-9 * static_cast<double>(kStep_ns);
  for (int k = 1; k * step_s <= kEnd_s; ++k) {
    const Quaterniond before = motion((k - 1) * step_s) * q_BI, after = motion(k * step_s) * q_BI;
    imu.time_ns.push_back(k * kStep_ns);
    imu.gyro_rad_s.push_back(so3::logarithm(before.conjugate() * after) / step_s);
    imu.accel_m_s2.push_back(after.conjugate() * Vector3d(0.0, 0.0, kUp_m_s2));
    imu.clip_flags.push_back(0);
  }
  return sensors;
}

std::vector<ReferencePose> poses_of(Motion motion, Changed changed, double late_s, double step_s) {
  std::vector<ReferencePose> poses;
  for (int k = 0; k * step_s <= kEnd_s; ++k) {
    const double time_s = k * step_s;
    poses.push_back({std::llround(1e9 * (time_s + late_s)), Vector3d(time_s, 0.0, 0.0), changed(motion(time_s))});
  }
  return poses;
}

/// Returns the reader's complaint about the poses, or its remark when it has no complaint.
std::string said(Motion motion, Changed changed, double late_s = 0.0, double step_s = 0.01) {
  Imported imported;
  imported.sensors = sensors_of(motion);
  const std::string complaint = test::complaint([&] {
    attach_poses(imported, poses_of(motion, changed, late_s, step_s), Eigen::Isometry3d::Identity(), "ref.tum");
  });
  EXPECT_EQ(imported.reference.has_value(), complaint.empty());
  return complaint.empty() ? imported.notes.back() : complaint;
}

TEST(ReferenceCheck, ASoundReferenceIsAccepted) {
  for (const double step_s : {0.001, 0.01, 0.1, 0.2, 0.5}) {
    EXPECT_THAT(said(hand_held, as_is, 0.0, step_s),
                AllOf(HasSubstr("the reference agrees with the gyro of 'imu': rotations differ by 0 %"),
                      Not(HasSubstr("caution"))))
        << step_s;
  }
  EXPECT_THAT(said(rolling, as_is), HasSubstr("rotations differ by 0 %"));
}

TEST(ReferenceCheck, WFirstIsRefused) {
  for (const double step_s : {0.001, 0.01, 0.1, 0.2}) {
    EXPECT_THAT(
        said(hand_held, with_w_first, 0.0, step_s),
        AllOf(HasSubstr("ref.tum: the rotations of the reference differ from the rotations of the gyro of 'imu' by"),
              HasSubstr("the rotations of reference and gyro would differ by only 0 %"),
              HasSubstr(
                  "The quaternions of the reference have w first, but the order must be qx qy qz qw; move the column")))
        << step_s;
  }
}

TEST(ReferenceCheck, InvertedPosesAreRefused) {
  for (const double step_s : {0.01, 0.2}) {
    EXPECT_THAT(said(hand_held, inverted, 0.0, step_s),
                HasSubstr("The poses of the reference describe the world in sensor axes, but must describe the sensor "
                          "in world axes"));
    // about one axis alone, the order with w first explains the rotations as well
    EXPECT_THAT(said(rolling, inverted, 0.0, step_s), HasSubstr("ref.tum: the rotations of the reference differ"));
  }
}

// the rotations are the same in both orders, and only gravity distinguishes the orders
TEST(ReferenceCheck, WFirstOfAMotionAboutOneAxisIsRefused) {
  EXPECT_THAT(said(rolling, with_w_first),
              AllOf(HasSubstr("differs from the vertical of the reference by more than 60 degrees"),
                    HasSubstr("have w first")));
}

TEST(ReferenceCheck, LateAndEarlyStampsAreRefused) {
  EXPECT_THAT(
      said(hand_held, as_is, 0.3),
      HasSubstr(
          "the time stamps of the poses are 0.300 s too late, but at most 0.15 s is accepted; subtract 0.300 s from"));
  EXPECT_THAT(said(hand_held, as_is, -0.3, 0.1), HasSubstr("0.300 s too early, but at most 0.15 s is accepted; add"));
  EXPECT_THAT(said(hand_held, as_is, 2.0), HasSubstr("2.000 s too late"));
  EXPECT_THAT(said(hand_held, with_w_first, 0.3), AllOf(HasSubstr("w first"), HasSubstr("0.300 s too late")));
}

// in sound recordings a sweep stamped at its end or at its start is wrong by 0.1 s
TEST(ReferenceCheck, ASmallDelayIsACaution) {
  EXPECT_THAT(said(hand_held, as_is, 0.1), AllOf(HasSubstr("caution"), HasSubstr("0.100 s too late")));
}

// the IMU may be the sensor whose mounting differs
TEST(ReferenceCheck, AnotherMountingIsACaution) {
  EXPECT_THAT(said(hand_held, turned), AllOf(HasSubstr("caution"), HasSubstr("check the mounting")));
  EXPECT_THAT(said(hand_held, turned, 0.3), HasSubstr("0.300 s too late"));
}

TEST(ReferenceCheck, WhatCannotBeDecidedIsReported) {
  EXPECT_THAT(said(hand_held, [](const Quaterniond&) { return Eigen::Quaterniond::Identity(); }),
              HasSubstr("the reference is not checked against the gyro of 'imu': there are too few pairs of poses"));
  EXPECT_THAT(said([](double) { return Eigen::Quaterniond::Identity(); }, as_is), HasSubstr("not checked"));
  EXPECT_THAT(said(
                  [](double time_s) {
                    return so3::exp({0.0, 0.0, time_s});
                  },
                  as_is),
              HasSubstr("this motion does not reveal whether the clock of the reference has a delay"));
  Imported without_imu;
  without_imu.sensors = sensors_of(hand_held);
  without_imu.sensors.imus.clear();
  without_imu.sensors.lidars.emplace_back().sweep_start_ns = {0, 1'000'000'000};
  without_imu.sensors.lidars.back().sweep_period_ns = 1'000'000'000;
  attach_poses(without_imu, poses_of(hand_held, as_is, 0.0, 0.1), Eigen::Isometry3d::Identity(), "ref.tum");
  EXPECT_THAT(without_imu.notes.back(), HasSubstr("not checked against a gyro: the recording has no IMU"));
}

class ReferenceCheckOfFiles : public test::TemporaryFolder {};

TEST_F(ReferenceCheckOfFiles, ATumFileIsChecked) {
  for (const auto& [changed, complaint] : {std::pair{&as_is, ""}, {&with_w_first, "have w first"}}) {
    std::string text;
    for (const ReferencePose& pose : poses_of(hand_held, changed, 0.0, 0.05)) {
      const Eigen::Vector4d& q = pose.q_WA.coeffs();
      text +=
          fmt::format("{:.9f} 0 0 0 {} {} {} {}\n", 1e-9 * static_cast<double>(pose.time_ns), q[0], q[1], q[2], q[3]);
    }
    fixture::put(folder_ / "ref.tum", text);
    Imported imported;
    imported.sensors = sensors_of(hand_held);
    EXPECT_THAT(test::complaint([&] {
                  attach_reference(imported, {folder_ / "ref.tum", "tum", true, false, {}, 0});
                }),
                HasSubstr(complaint));
  }
}

TEST_F(ReferenceCheckOfFiles, ATopicIsChecked) {
  sim::Recording recording;
  recording.sensors = sensors_of(hand_held);
  Imported sound;
  sound.sensors = recording.sensors;
  attach_poses(sound, poses_of(hand_held, as_is, 0.0, 0.01), Eigen::Isometry3d::Identity(), "");
  BagReading reading;
  reading.reference_topic = "/truth";
  for (const auto& [changed, complaint] :
       {std::pair{&as_is, ""}, {&inverted, "bag.mcap: topic /truth: the rotations"}}) {
    recording.truth = *sound.reference;
    for (Quaterniond& q : recording.truth.q_WB) q = changed(q);
    const StoredTruth truth = fixture::stored_truth(recording, folder_);
    export_mcap(recording.sensors, {0, &truth}, folder_ / "bag.mcap");
    reading.imu.T_BI = recording.sensors.imus.front().T_BI;
    const std::string found = test::complaint([&] { import_mcap(folder_ / "bag.mcap", reading); });
    EXPECT_THAT(found, HasSubstr(complaint));
    EXPECT_EQ(found.empty(), std::string(complaint).empty()) << found;
  }
}

}  // namespace
}  // namespace tumble::scenarios
