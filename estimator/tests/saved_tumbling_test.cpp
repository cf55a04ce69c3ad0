// SPDX-License-Identifier: BSD-3-Clause
// A robot reboots: a new object continues with calibration, saturation limits, map and pose of a saved run.
#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "damaged_bytes.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::Bytes;
using test::ThrownBody;

constexpr TimeNs kReboot_ns = 3'000'000'000;  // the body rests after its flight

ThrownBody body_that_comes_to_rest() {
  return ThrownBody{.end_s = 5.0};
}

/// Feeds the data from `from_ns` to `to_ns`, and returns the last registered sweep.
std::optional<TumblingOdometry::Sweep> feed_until(const ThrownBody& body, TimeNs from_ns, TimeNs to_ns,
                                                  TumblingOdometry& odometry) {
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  while (next < sweeps.size() && sweeps[next].start_ns < from_ns) ++next;
  std::optional<TumblingOdometry::Sweep> last;
  for (const ImuSample& sample : body.imu()) {
    if (sample.time_ns <= from_ns || sample.time_ns > to_ns) continue;
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns; ++next)
      EXPECT_TRUE(odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) last = std::move(sweep);
  }
  return last;
}

double truth_distance_m(const ThrownBody& body, const PoseState& pose) {
  return (pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation()).norm();
}

/// Returns parameters with an error of the mounting, which the run estimates.
TumblingOdometry::Params params_to_estimate(const ThrownBody& body) {
  TumblingOdometry::Params params = test::params_of(body);
  params.T_IL.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return params;
}

const TumblingOdometry& saved_run() {
  static const TumblingOdometry odometry = [] {
    const ThrownBody body = body_that_comes_to_rest();
    TumblingOdometry out(params_to_estimate(body));
    feed_until(body, 0, kReboot_ns, out);
    return out;
  }();
  return odometry;
}

TEST(SavedTumblingOdometry, ContinuesAtTheSavedPoseWithTheSavedMap) {
  const ThrownBody body = body_that_comes_to_rest();
  TumblingOdometry rebooted(params_to_estimate(body)), fresh(params_to_estimate(body));
  std::optional<PoseState> last;
  const Status status = rebooted.load(saved_run().save(), &last);
  ASSERT_TRUE(status.ok()) << status.message();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->time_ns, *saved_run().newest_imu_time_ns());
  EXPECT_GT(body.T_WI(3.0).translation().norm(), 1.0) << "else the saved pose is the origin";
  EXPECT_LT(truth_distance_m(body, *last), 0.05);
  EXPECT_FALSE(rebooted.health().ok()) << "not localised yet";

  const auto sweep = feed_until(body, kReboot_ns, 5'000'000'000, rebooted);
  ASSERT_TRUE(sweep);
  EXPECT_LT(truth_distance_m(body, sweep->result.pose), 0.05);
  EXPECT_EQ(rebooted.mapper().prior_map()->points.size(), saved_run().mapper().map().size());
  const auto lost = feed_until(body, kReboot_ns, 5'000'000'000, fresh);
  EXPECT_GT(truth_distance_m(body, lost->result.pose), 1.0) << "negative control: without load()";
}

TEST(SavedTumblingOdometry, KeepsCalibrationAndSaturationLimits) {
  const ThrownBody body = body_that_comes_to_rest();
  TumblingOdometry rebooted(params_to_estimate(body));
  ASSERT_TRUE(rebooted.load(saved_run().save()).ok());
  const BodyImuConstants before = saved_run().body_imu_calibration().constants;
  EXPECT_NE(before.lever_arm_m, body.lever_arm_I_m) << "else the run estimated nothing";
  EXPECT_EQ(rebooted.body_imu_calibration().constants, before);
  const Eigen::Matrix3d kept = rebooted.body_imu_calibration().covariance.topLeftCorner<3, 3>();
  const Eigen::Matrix3d found = saved_run().body_imu_calibration().covariance.topLeftCorner<3, 3>();
  EXPECT_TRUE(kept.isApprox(found, 1e-9));
  EXPECT_GT(rebooted.body_imu_calibration().covariance(3, 3), saved_run().body_imu_calibration().covariance(3, 3))
      << "biases change at a switch-on";
  const LidarImuCalibration lidar = rebooted.mapper().lidar_calibration();
  EXPECT_EQ(lidar.T_IL.matrix(), saved_run().mapper().lidar_calibration().T_IL.matrix());
  bool any = false;
  for (std::size_t c = 0; c < 6; ++c) {
    const double limit = saved_run().saturation_levels().axis_limit_state.channels[c].plateau_limit;
    EXPECT_EQ(rebooted.saturation_levels().axis_limit_state.channels[c].plateau_limit, limit) << c;
    any = any || limit > 0.0;
  }
  EXPECT_TRUE(any) << "else the run detected nothing";
  // also after a restart of the run, and after it is saved again
  rebooted.reset(Eigen::Isometry3d::Identity());
  EXPECT_EQ(rebooted.body_imu_calibration().constants, before);
  TumblingOdometry again(params_to_estimate(body));
  ASSERT_TRUE(again.load(rebooted.save()).ok());
  EXPECT_EQ(again.body_imu_calibration().constants, before);
  EXPECT_EQ(again.mapper().lidar_calibration().T_IL.matrix(), lidar.T_IL.matrix());
  EXPECT_EQ(again.mapper().prior_map()->points.size(), saved_run().mapper().map().size());
}

TEST(SavedTumblingOdometry, IsSavedAtAnyStage) {
  const ThrownBody body = body_that_comes_to_rest();
  TumblingOdometry odometry(params_to_estimate(body));
  TimeNs from_ns = 0;
  for (const TimeNs to_ns : {0l, 50'000'000l, 600'000'000l, 1'700'000'000l, 2'200'000'000l}) {
    if (to_ns > 0) feed_until(body, from_ns, to_ns, odometry);
    from_ns = to_ns;
    TumblingOdometry other(params_to_estimate(body));
    std::optional<PoseState> last;
    const Status status = other.load(odometry.save(), &last);
    ASSERT_TRUE(status.ok()) << to_ns << ": " << status.message();
    EXPECT_EQ(last.has_value(), to_ns > 500'000'000) << to_ns;
    if (last) {
      EXPECT_LT(truth_distance_m(body, *last), 0.1) << to_ns;
    }
  }
}

TEST(SavedTumblingOdometry, DamagedBytesAreRefused) {
  const ThrownBody body;
  TumblingOdometry odometry(params_to_estimate(body));
  feed_until(body, 0, 600'000'000, odometry);
  test::expect_damage_is_refused(odometry.save(), odometry);
}

/// The number of points in the bytes of the map is far larger than the bytes: the checksums are valid.
TEST(SavedTumblingOdometry, AHugeNumberOfPointsAllocatesNothing) {
  const ThrownBody body;
  TumblingOdometry odometry(params_to_estimate(body));
  const Bytes map = save_map({}), saved = odometry.save();
  ASSERT_TRUE(std::equal(map.rbegin(), map.rend(), saved.rbegin())) << "the bytes end with an empty map";
  for (const std::uint64_t count : {std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    Bytes huge = map;
    test::put_number(count, huge.size() - 8, huge);
    test::reseal(huge);
    Bytes bytes(saved.begin(), saved.end() - static_cast<std::ptrdiff_t>(map.size()));
    bytes.insert(bytes.end(), huge.begin(), huge.end());
    test::reseal(bytes);
    const Status status = odometry.load(bytes);
    EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
    EXPECT_STREQ(status.field, "map.points");
  }
}

TEST(SavedTumblingOdometry, AnotherRigIsRefused) {
  const ThrownBody body;
  const TumblingOdometry::Params params = params_to_estimate(body);
  const Bytes saved = TumblingOdometry(params).save();
  TumblingOdometry::Params other = params;
  other.lever_arm_I_m.x() = 0.5;
  Status status = TumblingOdometry(other).load(saved);
  EXPECT_STREQ(status.field, "lever_arm_m");
  EXPECT_EQ(status.value, params.lever_arm_I_m.x());
  EXPECT_EQ(status.bound, 0.5);
  other = params;
  other.T_IL.translation().y() = 0.1;
  status = TumblingOdometry(other).load(saved);
  EXPECT_STREQ(status.field, "T_IL");
  other = params;  // parameters of the estimation may change
  other.lag_s = 0.1;
  other.expert->mapping.expert.map.voxel_m = 0.3;
  EXPECT_TRUE(TumblingOdometry(other).load(saved).ok());
}

}  // namespace
}  // namespace tumble
