// SPDX-License-Identifier: BSD-3-Clause
// A gyro's zero offset beyond the bound of the rest detection is estimated at the initial rest.
#include "tumble/angular_velocity/detail/rest_detector.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

const Eigen::Vector3d kOffset_rad_s(0.05, -0.07, 0.03);  // 5 deg/s

std::vector<ImuSample> with_offset(std::vector<ImuSample> imu, const Eigen::Vector3d& offset_rad_s) {
  for (ImuSample& sample : imu) sample.angular_velocity_rad_s += offset_rad_s;
  return imu;
}

TEST(GyroOffset, ALargeOffsetDoesNotMoveTheThrow) {
  const ThrownBody body{.rest_s = 2.0, .end_s = 4.2};
  TumblingOdometry odometry(params_of(body));
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  auto sweep = sweeps.begin();
  for (const ImuSample& sample : with_offset(body.imu(), kOffset_rad_s)) {
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    for (; sweep != sweeps.end() && sweep->end_ns <= sample.time_ns; ++sweep)
      (void)odometry.add_sweep(sweep->start_ns, sweep->end_ns, sweep->points);
  }
  odometry.finish();
  std::optional<TumblingOdometry::Sweep> last;
  while (std::optional<TumblingOdometry::Sweep> next = odometry.take()) last = std::move(next);
  ASSERT_TRUE(last);
  const PoseState& pose = last->result.pose;
  const Eigen::Isometry3d T_WI = body.T_WI(seconds(pose.time_ns));
  EXPECT_LT((pose.position_W_m - T_WI.translation()).norm(), 0.05);
  EXPECT_LT(pose.orientation_W.angularDistance(Eigen::Quaterniond(T_WI.linear())), 0.02);
  EXPECT_LT((odometry.body_imu_calibration().constants.gyro_bias_rad_s - kOffset_rad_s).norm(), 5e-3);
  // a loaded run starts with the offset
  TumblingOdometry loaded(params_of(body));
  ASSERT_TRUE(loaded.load(odometry.save()).ok());
  EXPECT_LT((loaded.body_imu_calibration().constants.gyro_bias_rad_s - kOffset_rad_s).norm(), 5e-3);
}

TEST(GyroOffset, TheBatchRemovesALargeOffset) {
  const ThrownBody body{.rest_s = 2.0, .end_s = 4.2};
  AngularRateSmoother::Params params;
  params.model.nominal.lever_arm_m = body.lever_arm_I_m;
  std::vector<AngularRateState> rates;
  const std::vector<ImuSample> imu = with_offset(body.imu(), kOffset_rad_s);
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(imu, rates, report).ok());
  for (const AngularRateState& rate : rates) {
    if (seconds(rate.time_ns) < 1.8) {
      EXPECT_LT(rate.w_WI_I_rad_s.norm(), 5e-3) << rate.time_ns;
    }
  }
}

TEST(GyroOffset, SmallOffsetsAndMotionAreNotOffsets) {
  const ThrownBody body;
  EXPECT_EQ(GyroOffset().find(body.imu()), Eigen::Vector3d::Zero());
  EXPECT_EQ(GyroOffset().find(with_offset(body.imu(), {0.04, 0.0, 0.0})), Eigen::Vector3d::Zero());
  EXPECT_EQ(GyroOffset().find(with_offset(body.imu(), {0.3, 0.0, 0.0})), Eigen::Vector3d::Zero());
  // a rotation about a horizontal axis turns the force
  std::vector<ImuSample> turning = with_offset(body.imu(), {0.14, 0.0, 0.0});
  for (ImuSample& sample : turning)
    sample.specific_force_m_s2 =
        Eigen::AngleAxisd(-0.14 * seconds(sample.time_ns), Eigen::Vector3d::UnitX()) * sample.specific_force_m_s2;
  EXPECT_EQ(GyroOffset().find(turning), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace tumble
