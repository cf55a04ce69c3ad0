// SPDX-License-Identifier: BSD-3-Clause
// Wrong stamps, gaps and clocks that step back: one rule for both odometry classes.
#include "answers.hpp"
#include "odometry/imu_time_alignment.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

constexpr TimeNs kMilli_ns = 1'000'000;

TumblingOdometry tumbling() {
  return TumblingOdometry(params_of(ThrownBody{}));
}
RollingOdometry rolling() {
  return RollingOdometry(test::params_of({test::kPositions[0]}));
}
/// receives the readings with the number of their IMU, as a robot with several IMUs does
class RollingByImuNumber : public RollingOdometry {
 public:
  RollingByImuNumber() : RollingOdometry(rolling()) {}
  Status add_imu(const ImuSample& sample) { return RollingOdometry::add_imu(0, sample); }
};
std::vector<ImuSample> samples_for(const TumblingOdometry& /*of*/) {
  return ThrownBody{.rest_s = 2.5, .end_s = 2.5}.imu();
}
std::vector<ImuSample> samples_for(const RollingOdometry& /*of*/) {
  return test::unit_at(test::kPositions[0]);
}

/// Samples at rest that are not used if the stamp of sample `wrong` is changed by `ahead_ns`.
template <class Odometry>
std::size_t cost_of_one_stamp(Odometry odometry, std::size_t wrong, TimeNs ahead_ns) {
  std::vector<ImuSample> imu = samples_for(odometry);
  imu.resize(240);
  imu[wrong].time_ns += ahead_ns;
  std::size_t refused = 0;
  for (const ImuSample& sample : imu) refused += !odometry.add_imu(sample).ok();
  return refused + odometry.rejected_readings();
}

template <class Odometry>
class StampOrderOf : public testing::Test {
 protected:
  Odometry fresh() const;
};
template <>
TumblingOdometry StampOrderOf<TumblingOdometry>::fresh() const {
  return tumbling();
}
template <>
RollingOdometry StampOrderOf<RollingOdometry>::fresh() const {
  return rolling();
}
template <>
RollingByImuNumber StampOrderOf<RollingByImuNumber>::fresh() const {
  return {};
}
using Classes = testing::Types<TumblingOdometry, RollingOdometry, RollingByImuNumber>;
TYPED_TEST_SUITE(StampOrderOf, Classes);

TYPED_TEST(StampOrderOf, OneWrongStampCostsOneSample) {
  for (const TimeNs ahead_ns :
       {TimeNs{-3'600'000}, TimeNs{-900}, TimeNs{-250}, TimeNs{-40}, TimeNs{20}, TimeNs{25}, TimeNs{30}, TimeNs{35},
        TimeNs{50}, TimeNs{300}, TimeNs{900}, TimeNs{990}, TimeNs{1'010}, TimeNs{5'000}, TimeNs{3'600'000}}) {
    for (const std::size_t wrong : {1u, 2u, 40u, 120u})
      EXPECT_EQ(cost_of_one_stamp(this->fresh(), wrong, ahead_ns * kMilli_ns), 1u) << ahead_ns << " ms at " << wrong;
    // the first sample has no predecessor, so its stamp is found by the next two
    if (ahead_ns > 0) {
      EXPECT_LE(cost_of_one_stamp(this->fresh(), 0, ahead_ns * kMilli_ns), 1u) << ahead_ns << " ms at the start";
    }
  }
}

TYPED_TEST(StampOrderOf, AClockThatStepsBackRestartsTheRunAfterAStatedTime) {
  for (const TimeNs back_ms : {300, 5'000, 3'600'000}) {
    TypeParam odometry = this->fresh();
    std::vector<ImuSample> imu = samples_for(odometry);
    imu.resize(240);
    const TimeNs period_ns = imu[1].time_ns - imu[0].time_ns;
    std::size_t refused = 0;
    for (std::size_t k = 0; k < imu.size(); ++k) {
      if (k >= 100) imu[k].time_ns -= back_ms * kMilli_ns;
      const Status status = odometry.add_imu(imu[k]);
      refused += !status.ok();
      if (!status.ok()) {
        EXPECT_EQ(status.error_code, ErrorCode::time_order) << k;
      }
    }
    EXPECT_EQ(odometry.restart_count(), 1u) << back_ms;
    EXPECT_NEAR(double(refused * period_ns), 1e9 * StampOrder::kStepBack_s, 2.0 * double(period_ns)) << back_ms;
  }
}

TYPED_TEST(StampOrderOf, ExtremeStampsAreRefused) {
  TypeParam odometry = this->fresh(), undisturbed = this->fresh();
  std::vector<ImuSample> imu = samples_for(odometry);
  imu.resize(50);
  for (const ImuSample& sample : imu) {
    for (const TimeNs time_ns : {std::numeric_limits<TimeNs>::min(), -kStampMax_ns - 1, kStampMax_ns + 1,
                                 std::numeric_limits<TimeNs>::max()}) {
      ImuSample extreme = sample;
      extreme.time_ns = time_ns;
      EXPECT_EQ(odometry.add_imu(extreme).error_code, ErrorCode::out_of_range) << time_ns;
    }
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    ASSERT_TRUE(undisturbed.add_imu(sample).ok());
  }
  EXPECT_EQ(test::answers(odometry), test::answers(undisturbed));
}

TEST(StampOrder, ExtremeStampsOfTheMapperAreRefused) {
  LidarInertialOdometry mapper({});
  ImuSample sample;
  sample.specific_force_m_s2 = {0.0, 0.0, 9.8};
  AngularRateState rate;
  LidarInertialOdometry::SweepResult report;
  for (const TimeNs time_ns : {std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max()}) {
    sample.time_ns = rate.time_ns = time_ns;
    EXPECT_EQ(mapper.add_imu(sample, rate).error_code, ErrorCode::out_of_range);
    EXPECT_EQ(mapper.add_sweep(time_ns, time_ns, {}, report).error_code, ErrorCode::out_of_range);
  }
}

/// Feeds samples and sweeps with stamps that are `offset_ns` later than those of the body.
void feed(const ThrownBody& body, TimeNs from_ns, TimeNs to_ns, TimeNs offset_ns, TumblingOdometry& odometry,
          std::vector<TumblingOdometry::Sweep>& out) {
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  auto sweep = sweeps.begin();
  for (ImuSample sample : body.imu()) {
    if (sample.time_ns <= from_ns || sample.time_ns > to_ns) continue;
    sample.time_ns += offset_ns;
    (void)odometry.add_imu(sample);
    for (; sweep != sweeps.end() && sweep->end_ns + offset_ns <= sample.time_ns; ++sweep)
      (void)odometry.add_sweep(sweep->start_ns + offset_ns, sweep->end_ns + offset_ns, sweep->points);
    while (std::optional<TumblingOdometry::Sweep> done = odometry.take()) out.push_back(std::move(*done));
  }
}

TEST(StampOrder, TheMapContinuesAtTheNewestPoseAfterAStepBack) {
  const ThrownBody body{.rest_s = 2.5, .end_s = 4.7};
  constexpr TimeNs kStep_ns = 1'000'000'000, kBack_ns = -5'000'000'000;
  TumblingOdometry odometry(params_of(body));
  std::vector<TumblingOdometry::Sweep> out;
  feed(body, 0, kStep_ns, 0, odometry, out);
  const std::size_t before = out.size();
  feed(body, kStep_ns, 10 * kStep_ns, kBack_ns, odometry, out);
  odometry.finish();
  while (std::optional<TumblingOdometry::Sweep> done = odometry.take()) out.push_back(std::move(*done));
  EXPECT_EQ(odometry.restart_count(), 1u);
  ASSERT_GT(out.size(), before + 30);
  const PoseState& last = out.back().result.pose;
  const Eigen::Isometry3d T_WI = body.T_WI(seconds(last.time_ns - kBack_ns));
  EXPECT_LT((last.position_W_m - T_WI.translation()).norm(), 0.05);
  EXPECT_LT(last.orientation_W.angularDistance(Eigen::Quaterniond(T_WI.linear())), 0.03);
}

Eigen::Isometry3d elsewhere() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(30.0, -4.0, 2.0);
  return T;
}

TEST(StampOrder, AResetMapStartsAtTheGivenPose) {
  const ThrownBody body;
  TumblingOdometry odometry(params_of(body));
  std::vector<TumblingOdometry::Sweep> first, second, third;
  feed(body, 0, 10'000'000'000, 0, odometry, first);
  odometry.reset();
  EXPECT_FALSE(odometry.newest_imu_time_ns());
  feed(body, 0, 10'000'000'000, 0, odometry, second);
  odometry.reset(elsewhere());
  TumblingOdometry copy = odometry;
  feed(body, 0, 10'000'000'000, 0, odometry, third);
  ASSERT_EQ(second.size(), first.size());
  ASSERT_EQ(third.size(), first.size());
  const PoseState &a = first.back().result.pose, &b = second.back().result.pose, &c = third.back().result.pose;
  EXPECT_EQ(a.position_W_m, b.position_W_m);
  EXPECT_LT((elsewhere() * a.position_W_m - c.position_W_m).norm(), 0.01);
  EXPECT_LT(c.orientation_W.angularDistance(Eigen::Quaterniond(elsewhere().linear()) * a.orientation_W), 0.01);
  const auto spread_m2 = [](const PoseState& pose) { return pose.covariance.diagonal().head(3).sum(); };
  EXPECT_NEAR(spread_m2(c), spread_m2(a), 0.1 * spread_m2(a));

  std::vector<TumblingOdometry::Sweep> fourth;
  feed(body, 0, 10'000'000'000, 0, copy, fourth);
  EXPECT_EQ(fourth.back().result.pose.position_W_m, c.position_W_m);
}

std::vector<RollingOdometry::Pose> roll(RollingOdometry& odometry, const std::vector<ImuSample>& imu) {
  for (const ImuSample& sample : imu) (void)odometry.add_imu(sample);
  odometry.finish();
  std::vector<RollingOdometry::Pose> out;
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) out.push_back(*pose);
  return out;
}

TEST(StampOrder, AResetSphereStartsAtTheGivenPose) {
  RollingOdometry odometry = rolling();
  const std::vector<ImuSample> imu = samples_for(odometry);
  const std::vector<RollingOdometry::Pose> first = roll(odometry, imu);
  odometry.reset(elsewhere());
  RollingOdometry copy = odometry;
  const std::vector<RollingOdometry::Pose> second = roll(odometry, imu), third = roll(copy, imu);
  ASSERT_EQ(second.size(), first.size());
  ASSERT_EQ(third.size(), first.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_LT((elsewhere() * first[k].pose.position_W_m - second[k].pose.position_W_m).norm(), 1e-9);
    EXPECT_LT((elsewhere().linear() * first[k].pose.velocity_W_m_s - second[k].pose.velocity_W_m_s).norm(), 1e-9);
    EXPECT_EQ(second[k].pose.position_W_m, third[k].pose.position_W_m);
  }
}

TEST(StampOrder, ASphereContinuesAtItsNewestPoseAfterAGap) {
  RollingOdometry odometry = rolling();
  std::vector<ImuSample> imu = samples_for(odometry);
  std::vector<ImuSample> parked = imu;  // rests after the path
  for (ImuSample& sample : parked) {
    sample.time_ns += imu.back().time_ns + 2'000'000'000;
    sample.angular_velocity_rad_s = imu.back().angular_velocity_rad_s;
    sample.specific_force_m_s2 = imu.back().specific_force_m_s2;
  }
  imu.insert(imu.end(), parked.begin(), parked.end());
  const std::vector<RollingOdometry::Pose> poses = roll(odometry, imu);
  EXPECT_EQ(odometry.restart_count(), 1u);
  EXPECT_EQ(poses.size(), imu.size() - 1);
  EXPECT_NEAR(poses.back().pose.position_W_m.x(), test::kPathLength_m, 0.02 * test::kPathLength_m);
  EXPECT_FALSE(poses.front().position_uncertain);
  EXPECT_TRUE(poses.back().position_uncertain);
}

}  // namespace
}  // namespace tumble
