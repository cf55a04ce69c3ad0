// SPDX-License-Identifier: BSD-3-Clause
// After a tracking failure, health() reports the failure until the end of the run.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

/// Runs the odometry. Sweeps that begin from `blind_from_s` to `blind_to_s` have no returns.
void run(const ThrownBody& body, double blind_from_s, double blind_to_s, TumblingOdometry& odometry) {
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  for (const ImuSample& sample : body.imu()) {
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns; ++next) {
      const double at_s = seconds(sweeps[next].start_ns);
      const bool blind = at_s >= blind_from_s && at_s < blind_to_s;
      const std::vector<LidarPoint> none;
      ASSERT_TRUE(
          odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, blind ? none : sweeps[next].points).ok());
    }
    while (odometry.take()) continue;
  }
  odometry.finish();
}

TEST(TumblingOdometry, DoubtsAPlaceThatInertiaAloneHasFound) {
  ThrownBody body;
  TumblingOdometry seeing(params_of(body)), lost(params_of(body));
  run(body, 0.0, 0.0, seeing);
  EXPECT_TRUE(seeing.health().ok()) << seeing.health().worst_message();
  body.end_s = 9.0;
  run(body, 1.0, body.end_s, lost);
  ASSERT_EQ(lost.health().findings.size(), 1u);
  EXPECT_EQ(lost.health().findings.front().kind, HealthFinding::Kind::tracking_lost);
  EXPECT_GT(lost.health().findings.front().since_ns, TimeNs{1'000'000'000});
  EXPECT_TRUE(lost.health().invalidates_estimate());
  const Status health = lost.health();
  EXPECT_STREQ(health.field, "standard deviation in m of the position in the map");
  EXPECT_GT(health.value, health.bound);
  EXPECT_EQ(health.bound, params_of(body).expert->mapping.expert.matching.distance_m);
}

/// The error of the first stated mounting is within the stated uncertainty. The second stated mounting is wrong by ten
/// degrees.
TEST(TumblingOdometry, DoubtsACalibrationThatMovedFurtherThanWasGiven) {
  const ThrownBody body;
  TumblingOdometry::Params params = params_of(body);
  params.T_IL.linear() = Eigen::AngleAxisd(0.5 * params.mount_sigma_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  TumblingOdometry near(params);
  run(body, 0.0, 0.0, near);
  EXPECT_TRUE(near.health().ok()) << near.health().worst_message();
  params.T_IL.linear() = Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitX()).toRotationMatrix();
  TumblingOdometry far(params);
  run(body, 0.0, 0.0, far);
  const Status health = far.health();
  EXPECT_EQ(health.error_code, ErrorCode::out_of_range);
  EXPECT_NE(health.message().find("change of the lidar-IMU calibration"), std::string::npos) << health.message();
  EXPECT_GT(health.value, LidarImuCalibrationPrior::kDistanceMax_sigmas);
}

}  // namespace
}  // namespace tumble
