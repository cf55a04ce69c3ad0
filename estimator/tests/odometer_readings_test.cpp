// SPDX-License-Identifier: BSD-3-Clause
// Odometer readings of TumblingOdometry: benefit of true readings, harm of wrong ones, and that none is lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "answers.hpp"
#include "odometry/odometry_pass.hpp"
#include "odometry/second_pass.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

constexpr TimeNs kTenth_ns = 100'000'000;
constexpr TimeNs kSeesNothingFrom_ns = 1'300'000'000, kSeesNothingTo_ns = 2'300'000'000;  // most of the flight

VelocityReading velocity_of(const ThrownBody& body, TimeNs time_ns, double sigma_m_s) {
  constexpr double kStep_s = 1e-5;
  const double t = seconds(time_ns);
  const Eigen::Vector3d v_W =
      (body.T_WI(t + kStep_s).translation() - body.T_WI(t - kStep_s).translation()) / (2.0 * kStep_s);
  return {time_ns, body.T_WI(t).linear().transpose() * v_W, sigma_m_s};
}

RelativePoseReading motion_of(const ThrownBody& body, TimeNs from_ns, TimeNs to_ns, double sigma_m, double sigma_rad) {
  RelativePoseReading out{from_ns, to_ns, body.T_WI(seconds(from_ns)).inverse() * body.T_WI(seconds(to_ns)), {}};
  out.covariance.setZero();
  out.covariance.diagonal() << Eigen::Vector3d::Constant(sigma_m * sigma_m),
      Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return out;
}

/// Adds the readings of a sweep, just before the sweep is added.
using AddReading = std::function<void(const ThrownBody&, const ThrownBody::Sweep&, TumblingOdometry&)>;

void nothing(const ThrownBody&, const ThrownBody::Sweep&, TumblingOdometry&) {}
void true_velocity(const ThrownBody& body, const ThrownBody::Sweep& sweep, TumblingOdometry& odometry) {
  EXPECT_TRUE(odometry.add_velocity(velocity_of(body, sweep.end_ns - 30'000'000, 0.02)).ok());
}
void true_motion(const ThrownBody& body, const ThrownBody::Sweep& sweep, TumblingOdometry& odometry) {
  EXPECT_TRUE(odometry.add_relative_pose(motion_of(body, sweep.start_ns, sweep.end_ns, 0.005, 0.005)).ok());
}
void wrong_velocity(const ThrownBody& body, const ThrownBody::Sweep& sweep, TumblingOdometry& odometry) {
  VelocityReading reading = velocity_of(body, sweep.end_ns, 0.01);
  reading.v_WI_I_m_s.x() += 2.0;
  EXPECT_TRUE(odometry.add_velocity(reading).ok());
}

struct Course {
  std::vector<TumblingOdometry::Sweep> sweeps;
  double worst_m = 0.0, worst_rad = 0.0, end_m = 0.0, sum_m = 0.0;
};

void take_course(const ThrownBody& body, TumblingOdometry& odometry, Course& run) {
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
    const PoseState& pose = sweep->result.pose;
    const Eigen::Isometry3d T_WI = body.T_WI(seconds(pose.time_ns));
    run.end_m = (pose.position_W_m - T_WI.translation()).norm();
    run.worst_m = std::max(run.worst_m, run.end_m);
    run.sum_m += run.end_m;
    run.worst_rad = std::max(run.worst_rad, pose.orientation_W.angularDistance(Eigen::Quaterniond(T_WI.linear())));
    run.sweeps.push_back(std::move(*sweep));
  }
}

/// Samples `from` to `to` - 1 and the sweeps that end by then.
void hand_over(const ThrownBody& body, const std::vector<ThrownBody::Sweep>& sweeps, std::size_t from, std::size_t to,
               const AddReading& add_reading, TumblingOdometry& odometry, Course& run) {
  const std::vector<ImuSample> imu = body.imu();
  for (std::size_t k = from; k < std::min(to, imu.size()); ++k) {
    ASSERT_TRUE(odometry.add_imu(imu[k]).ok());
    const TimeNs before_ns = k == 0 ? 0 : imu[k - 1].time_ns;
    for (const ThrownBody::Sweep& sweep : sweeps) {
      if (sweep.end_ns <= before_ns || sweep.end_ns > imu[k].time_ns) continue;
      add_reading(body, sweep, odometry);
      ASSERT_TRUE(odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points).ok());
    }
    take_course(body, odometry, run);
  }
}

constexpr std::size_t kToTheEnd = std::numeric_limits<std::size_t>::max();

Course course_of(const ThrownBody& body, const std::vector<ThrownBody::Sweep>& sweeps, const AddReading& add_reading,
                 TumblingOdometry& odometry) {
  Course run;
  hand_over(body, sweeps, 0, kToTheEnd, add_reading, odometry, run);
  odometry.finish();
  take_course(body, odometry, run);
  return run;
}

TumblingOdometry::Params single_pass(const ThrownBody& body) {
  TumblingOdometry::Params params = params_of(body);
  params.expert->first_seconds_reprocessing.after_motion_s = 0.0;
  return params;
}

void expect_same(const Course& a, const Course& b) {
  ASSERT_EQ(a.sweeps.size(), b.sweeps.size());
  for (std::size_t k = 0; k < a.sweeps.size(); ++k) {
    EXPECT_EQ(a.sweeps[k].result.pose.position_W_m, b.sweeps[k].result.pose.position_W_m) << k;
    EXPECT_EQ(a.sweeps[k].result.pose.orientation_W.coeffs(), b.sweeps[k].result.pose.orientation_W.coeffs()) << k;
    EXPECT_EQ(a.sweeps[k].result.pose.covariance, b.sweeps[k].result.pose.covariance) << k;
  }
}

TEST(OdometerReadings, TrueReadingsDoNoHarm) {
  const ThrownBody body;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  TumblingOdometry plain(single_pass(body)), with_velocity(single_pass(body)), with_motion(single_pass(body));
  const Course without = course_of(body, sweeps, nothing, plain);
  for (const auto& [add_reading, odometry] : {std::pair<AddReading, TumblingOdometry*>(true_velocity, &with_velocity),
                                              std::pair<AddReading, TumblingOdometry*>(true_motion, &with_motion)}) {
    const Course with = course_of(body, sweeps, add_reading, *odometry);
    EXPECT_LE(with.worst_m, without.worst_m);
    EXPECT_LE(with.sum_m, without.sum_m);
    EXPECT_LE(with.end_m, without.end_m);
    // a velocity contains little information about attitude, whose error at the catch is three degrees
    EXPECT_LE(with.worst_rad, (odometry == &with_motion ? 0.5 : 1.25) * without.worst_rad);
    EXPECT_TRUE(odometry->health().ok()) << odometry->health().worst_message();
  }
}

/// The lidar has no returns from the throw to the catch. Inertial prediction with the clipped gyro fails.
TEST(OdometerReadings, TrueReadingsReplaceALidarWithoutReturns) {
  const ThrownBody body;
  std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  for (ThrownBody::Sweep& sweep : sweeps) {
    if (sweep.start_ns >= kSeesNothingFrom_ns && sweep.end_ns <= kSeesNothingTo_ns) sweep.points.clear();
  }
  TumblingOdometry plain(single_pass(body)), with_velocity(single_pass(body)), with_motion(single_pass(body));
  const Course without = course_of(body, sweeps, nothing, plain);
  const Course velocity = course_of(body, sweeps, true_velocity, with_velocity);
  const Course motion = course_of(body, sweeps, true_motion, with_motion);
  EXPECT_LT(velocity.worst_m, 0.7 * without.worst_m) << without.worst_m;
  EXPECT_LT(motion.worst_m, 0.5 * without.worst_m) << without.worst_m;
  EXPECT_LT(motion.worst_rad, 0.5 * without.worst_rad) << without.worst_rad;
  EXPECT_LT(motion.worst_m, 0.05);
}

TEST(OdometerReadings, AConfidentWrongReadingDoesHarmAndIsReported) {  // negative control
  const ThrownBody body;
  TumblingOdometry plain(single_pass(body)), misled(single_pass(body));
  const Course without = course_of(body, body.sweeps(), nothing, plain);
  const Course wrong = course_of(body, body.sweeps(), wrong_velocity, misled);
  EXPECT_GT(wrong.worst_m, without.worst_m);
  EXPECT_TRUE(plain.health().ok());
  EXPECT_FALSE(misled.health().ok());
}

/// A sweep waits for the lag. A reading that is added after the sweep gives the same result as one added before it,
/// also in the second pass.
TEST(OdometerReadings, AReadingBelongsToItsSweepWhileItWaits) {
  ThrownBody body;
  body.end_s = 4.2;
  TumblingOdometry::Params params = params_of(body);
  params.expert->first_seconds_reprocessing.after_motion_s = 0.9;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  TumblingOdometry before(params), after(params), without(params);
  const Course first = course_of(body, sweeps, true_motion, before);
  // adds the reading of the previous sweep, which waits
  const AddReading late = [&](const ThrownBody& of, const ThrownBody::Sweep& sweep, TumblingOdometry& odometry) {
    if (sweep.start_ns < kTenth_ns) return;
    (void)odometry.add_relative_pose(motion_of(of, sweep.start_ns - kTenth_ns, sweep.start_ns, 0.005, 0.005));
    if (sweep.end_ns == sweeps.back().end_ns) true_motion(of, sweep, odometry);
  };
  expect_same(first, course_of(body, sweeps, late, after));
  EXPECT_TRUE(before.first_seconds_reprocessing_applied());
  const Course none = course_of(body, sweeps, nothing, without);
  EXPECT_NE(first.sweeps.back().result.pose.position_W_m, none.sweeps.back().result.pose.position_W_m);
  EXPECT_EQ(test::answers(before), test::answers(after));
}

/// Returns the pose after the second pass. Only the second pass has readings, so the pose shows whether it used them.
Eigen::Vector3d after_second_pass(bool with_readings) {
  const ThrownBody body;
  MotionRegimeStream::Params rate = TumblingOdometry::Params::Expert::default_rate_params();
  rate.rate.model.nominal.lever_arm_m = body.lever_arm_I_m;
  const LidarInertialOdometry::Params mapping = TumblingOdometry::Params::Expert::default_mapping_params();
  OdometryPass first(rate, mapping);
  FirstSecondsReprocessing again(FirstSecondsReprocessing::Params{}, rate, mapping);
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  for (const ImuSample& sample : body.imu()) {
    EXPECT_TRUE(first.add_imu(sample).ok());
    again.store_input(sample);
    for (; next < sweeps.size() && first.has_rates_until(sweeps[next].end_ns); ++next) {
      const ThrownBody::Sweep& sweep = sweeps[next];
      LidarInertialOdometry::SweepResult report;
      (void)first.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, {}, report);
      std::optional<OdometerReading> reading;
      if (with_readings) reading = motion_of(body, sweep.start_ns, sweep.end_ns, 0.002, 0.002);
      again.store_input(sweep.start_ns, sweep.end_ns, sweep.points, reading, report.verdict);
    }
  }
  again.complete_second_pass(first);
  EXPECT_TRUE(again.is_applied());
  PoseState pose;
  EXPECT_TRUE(first.newest(pose, nullptr).ok());
  return pose.position_W_m;
}

TEST(OdometerReadings, TheSecondPassUsesReadingsAgain) {
  const Eigen::Vector3d without_m = after_second_pass(false), with_m = after_second_pass(true);
  EXPECT_EQ(without_m, after_second_pass(false));
  EXPECT_NE(without_m, with_m);
}

TEST(OdometerReadings, ACopyContinuesWhileAReadingWaits) {
  const ThrownBody body;
  TumblingOdometry::Params params = params_of(body);
  params.expert->first_seconds_reprocessing.after_motion_s = 0.9;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  TumblingOdometry whole(params);
  const Course run = course_of(body, sweeps, true_motion, whole);
  for (const std::size_t split : {std::size_t{172}, std::size_t{255}}) {
    SCOPED_TRACE(split);
    TumblingOdometry first(params);
    Course parts;
    hand_over(body, sweeps, 0, split, true_motion, first, parts);
    TumblingOdometry copy = first;
    hand_over(body, sweeps, split, kToTheEnd, true_motion, copy, parts);
    copy.finish();
    take_course(body, copy, parts);
    expect_same(run, parts);
    EXPECT_EQ(test::answers(copy), test::answers(whole));
  }
}

TEST(OdometerReadings, ErrorsAreValuesAndChangeNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ThrownBody body;
  const TimeNs now_ns = 800'000'000;
  TumblingOdometry odometry(single_pass(body));
  EXPECT_EQ(odometry.add_velocity({now_ns, Eigen::Vector3d::Zero(), 0.1}).error_code, ErrorCode::empty);
  Course run;
  hand_over(body, body.sweeps(), 0, 80, nothing, odometry, run);
  ASSERT_GT(run.sweeps.size(), 3u);
  const TimeNs done_ns = run.sweeps.back().result.pose.time_ns;
  const std::vector<double> before = test::answers(odometry);
  EXPECT_EQ(odometry.add_velocity({now_ns, {0.0, nan, 0.0}, 0.1}).error_code, ErrorCode::non_finite);
  EXPECT_EQ(odometry.add_velocity({now_ns, Eigen::Vector3d::Zero(), 0.0}).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_velocity({now_ns, Eigen::Vector3d::Zero(), -0.1}).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_velocity({done_ns, Eigen::Vector3d::Zero(), 0.1}).error_code, ErrorCode::time_order);
  constexpr TimeNs kFar_ns = std::numeric_limits<TimeNs>::max();
  for (const TimeNs time_ns : {now_ns + 1'100'000'000, kFar_ns})
    EXPECT_EQ(odometry.add_velocity({time_ns, Eigen::Vector3d::Zero(), 0.1}).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_velocity({-kFar_ns, Eigen::Vector3d::Zero(), 0.1}).error_code, ErrorCode::time_order);
  const auto motion = [&](TimeNs from_ns, TimeNs to_ns) { return motion_of(body, from_ns, to_ns, 0.01, 0.01); };
  EXPECT_EQ(odometry.add_relative_pose(motion(now_ns, now_ns)).error_code, ErrorCode::time_order);
  EXPECT_EQ(odometry.add_relative_pose(motion(done_ns - 50'000'000, now_ns)).error_code, ErrorCode::time_order);
  RelativePoseReading reading = motion(done_ns, now_ns);
  reading.covariance(3, 3) = 0.0;
  EXPECT_EQ(odometry.add_relative_pose(reading).error_code, ErrorCode::out_of_range);
  for (const auto& [from_ns, to_ns] : {std::pair(-kFar_ns, now_ns), std::pair(done_ns, kFar_ns)}) {
    reading = motion(done_ns, now_ns);
    reading.from_ns = from_ns;
    reading.to_ns = to_ns;
    EXPECT_FALSE(odometry.add_relative_pose(reading).ok());
  }
  EXPECT_EQ(test::answers(odometry), before);

  // a reading that spans two sweeps belongs to neither; the number of waiting readings is limited
  EXPECT_TRUE(odometry.add_relative_pose(motion(done_ns + 50'000'000, done_ns + 150'000'000)).ok());
  Status status;
  std::size_t waiting = 1;
  for (; status.ok() && waiting < 5000; ++waiting)
    status = odometry.add_velocity({done_ns + 500'000'000, Eigen::Vector3d::Zero(), 1.0});
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_STREQ(status.field, "readings waiting");
  EXPECT_EQ(waiting, 1025u);
  hand_over(body, body.sweeps(), 80, 130, nothing, odometry, run);
  EXPECT_TRUE(odometry.add_velocity({1'300'000'000, Eigen::Vector3d::Zero(), 1.0}).ok()) << "there is room again";
}

/// An unused reading gives the same bits as no reading.
TEST(OdometerReadings, AReadingThatNoSweepUsesChangesNoBit) {
  const ThrownBody body;
  TumblingOdometry plain(single_pass(body)), asked(single_pass(body));
  std::size_t accepted = 0;
  const AddReading spanning_two_sweeps = [&](const ThrownBody& of, const ThrownBody::Sweep& sweep,
                                             TumblingOdometry& odometry) {
    accepted +=
        odometry.add_relative_pose(motion_of(of, sweep.end_ns - 50'000'000, sweep.end_ns + 50'000'001, 0.01, 0.01))
            .ok();
  };
  expect_same(course_of(body, body.sweeps(), nothing, plain),
              course_of(body, body.sweeps(), spanning_two_sweeps, asked));
  EXPECT_GT(accepted, 20u);
}

}  // namespace
}  // namespace tumble
