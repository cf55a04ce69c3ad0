// SPDX-License-Identifier: BSD-3-Clause
// Tests of gaps in the data of IMU and lidar: live, with a lag, and with the whole recording.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "live_readings.hpp"
#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

constexpr double kWholeRun = TumblingOdometry::kWholeRecording;

/// DataGap is an interval without data, during the rest before the throw.
struct DataGap {
  double imu_s = 0.0, lidar_s = 0.0;
  bool covers(double length_s, TimeNs time_ns) const {
    return time_ns > 1'500'000'000 && seconds(time_ns) < 1.5 + length_s;
  }
};

struct ThrownWithGap {
  std::size_t poses = 0, restarts = 0;
  PoseState last;
  double error_m = 0.0, sigma_m = 0.0;
  bool finished = false;
};

/// Processes the body's data in real time.
ThrownWithGap throw_body(const ThrownBody& body, const DataGap& gap, double lag_s) {
  TumblingOdometry::Params params = test::params_of(body);
  params.lag_s = lag_s;
  TumblingOdometry odometry(params);
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  const auto add_sweeps = [&](TimeNs until_ns) {
    for (; next < sweeps.size() && sweeps[next].end_ns <= until_ns; ++next) {
      if (!gap.covers(gap.lidar_s, sweeps[next].end_ns))
        (void)odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points);
    }
  };
  ThrownWithGap out;
  const auto take = [&] {
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      if (sweep->result.trajectory.empty()) continue;
      out.last = sweep->result.pose;
      ++out.poses;
    }
  };
  for (const ImuSample& sample : test::noisy(body.imu(), body.rail_rad_s)) {
    if (!gap.covers(gap.imu_s, sample.time_ns)) (void)odometry.add_imu(sample);
    add_sweeps(sample.time_ns);
    take();
  }
  out.finished = odometry.finish().ok();
  take();
  out.restarts = odometry.restart_count();
  out.error_m = (out.last.position_W_m - body.T_WI(seconds(out.last.time_ns)).translation()).norm();
  out.sigma_m = std::sqrt(out.last.covariance.topLeftCorner<3, 3>().trace());
  return out;
}

TEST(Gaps, LiveLagAndWholeRecordingContinue) {
  for (const DataGap& gap : {DataGap{0.3, 0.0}, DataGap{2.0, 0.0}, DataGap{0.0, 0.3}, DataGap{0.0, 2.0},
                             DataGap{2.0, 2.0}, DataGap{6.0, 6.0}}) {
    ThrownBody body;
    body.rest_s = 4.2 + std::max(gap.imu_s, gap.lidar_s);
    body.end_s = body.rest_s + 2.3;
    const ThrownWithGap live = throw_body(body, gap, 0.0), lag = throw_body(body, gap, 0.2),
                        whole = throw_body(body, gap, kWholeRun);
    for (const ThrownWithGap* each : {&live, &lag, &whole}) {
      EXPECT_TRUE(each->finished);
      EXPECT_NEAR(seconds(each->last.time_ns), body.end_s, 0.11) << gap.imu_s << " " << gap.lidar_s;
      EXPECT_EQ(each->restarts, gap.imu_s > 1.0 ? 1u : 0u);
      const double bound_m = each == &live ? 0.2 : 0.1;  // without a lag, the throw alone causes an error of 0.09 m
      EXPECT_LT(each->error_m, bound_m) << gap.imu_s << " "
                                        << gap.lidar_s;  // the bound of TumblingOdometry after an equal gap
      EXPECT_LT(each->error_m, 4.0 * each->sigma_m + 0.01) << gap.imu_s << " " << gap.lidar_s;
    }
    EXPECT_EQ(whole.poses, lag.poses) << gap.imu_s << " " << gap.lidar_s;
  }
}

TEST(Gaps, RatesOfTheWholeRecordingContinueWithOneCalibration) {
  ThrownBody body;
  TumblingOdometry::Params params = test::params_of(body);
  params.lag_s = kWholeRun;
  TumblingOdometry odometry(params), reference(params);
  std::vector<ImuSample> imu = body.imu();
  for (const ImuSample& sample : imu) ASSERT_TRUE(reference.add_imu(sample).ok());
  ASSERT_TRUE(reference.finish().ok());
  for (std::size_t k = 100; k < imu.size(); ++k) imu[k].time_ns += 20'000'000'000;
  for (std::size_t k = 0; k < imu.size(); ++k)
    EXPECT_EQ(odometry.add_imu(imu[k]).error_code, k == 100 ? ErrorCode::gap : ErrorCode::none) << k;
  ASSERT_TRUE(odometry.finish().ok());
  ASSERT_EQ(odometry.whole_recording_result()->rates.size(), imu.size() - 1);
  double apart_rad_s = 0.0;
  for (std::size_t k = 110; k < imu.size(); ++k) {
    const Eigen::Vector3d apart = odometry.whole_recording_result()->rates[k - 1].w_WI_I_rad_s -
                                  reference.whole_recording_result()->rates[k].w_WI_I_rad_s;
    apart_rad_s = std::max(apart_rad_s, apart.norm());
  }
  EXPECT_LT(apart_rad_s, 0.05);  // the gap shortens the rest that determines the gyro's bias by 0.2 s
}

struct RolledWithGap {
  std::size_t poses = 0, restarts = 0;
  RollingOdometry::Pose last;
  double error_m = 0.0, sigma_m = 0.0, yaw_sigma_rad = 0.0;
};

/// Runs a sphere whose IMUs are silent between `from_s` and `to_s` of the data, and for `more_s` longer.
RolledWithGap roll_with_gap(double from_s, double to_s, double more_s, double lag_s) {
  RollingOdometry::Params params = test::params_of(test::kPositions);
  params.lag_s = lag_s;
  RollingOdometry odometry(params);
  std::vector<std::vector<ImuSample>> units;
  for (const Eigen::Vector3d& position_m : test::kPositions) units.push_back(test::noisy(test::unit_at(position_m)));
  RolledWithGap out;
  const auto take = [&] {
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) {
      out.last = *pose;
      ++out.poses;
    }
  };
  for (std::size_t k = 0; k < units[0].size(); ++k) {
    if (seconds(units[0][k].time_ns) > from_s && seconds(units[0][k].time_ns) < to_s) continue;
    for (std::size_t unit = 0; unit < units.size(); ++unit) {
      ImuSample sample = units[unit][k];
      if (seconds(sample.time_ns) > from_s) sample.time_ns += static_cast<TimeNs>(1e9 * more_s);
      (void)odometry.add_imu(unit, sample);
    }
    take();
  }
  EXPECT_TRUE(odometry.finish().ok());
  take();
  out.restarts = odometry.restart_count();
  const auto& P = out.last.pose.covariance;
  out.error_m = (out.last.pose.position_W_m - Eigen::Vector3d(test::kPathLength_m, 0.0, 0.0)).norm();
  out.sigma_m = std::sqrt(P.topLeftCorner<2, 2>().trace());
  out.yaw_sigma_rad = std::sqrt(P(5, 5));
  return out;
}

TEST(Gaps, ASphereContinuesAndItsCovarianceKnowsTheGap) {
  for (const double lag_s : {0.0, 0.5, RollingOdometry::kWholeRecording}) {
    // the first gap is at rest; the second gap hides half of the rolled path
    for (const double gap_s : {0.3, 2.0, 20.0}) {
      const RolledWithGap rest = roll_with_gap(1.2, 1.3, gap_s - 0.1, lag_s);
      EXPECT_EQ(rest.restarts, gap_s > 1.0 ? 1u : 0u) << lag_s << " " << gap_s;
      EXPECT_LT(rest.error_m, 0.01 * test::kPathLength_m) << lag_s << " " << gap_s;
      EXPECT_EQ(rest.last.position_uncertain, gap_s > 1.0);
    }
    const RolledWithGap moving = roll_with_gap(2.0, 3.2, 0.0, lag_s);
    EXPECT_EQ(moving.restarts, 1u) << lag_s;
    EXPECT_GT(moving.error_m, 0.2) << lag_s;                  // the gap hides motion
    EXPECT_LT(moving.error_m, test::kPathLength_m) << lag_s;  // the error is smaller than the path
    EXPECT_LT(moving.error_m, 3.0 * moving.sigma_m) << lag_s;
    EXPECT_GT(moving.yaw_sigma_rad, 0.5) << lag_s;
    EXPECT_TRUE(moving.last.position_uncertain);
  }
}

TEST(Gaps, TheWholeRecordingOfASphereStartsAtTheGivenPose) {
  RollingOdometry::Params params = test::params_of({test::kPositions[0]});
  params.lag_s = RollingOdometry::kWholeRecording;
  RollingOdometry odometry(params);
  Eigen::Isometry3d T_WG = Eigen::Isometry3d::Identity();
  T_WG.translation() = Eigen::Vector3d(3.0, -2.0, 0.5);
  odometry.reset(T_WG);
  for (const ImuSample& sample : test::noisy(test::unit_at(test::kPositions[0])))
    ASSERT_TRUE(odometry.add_imu(sample).ok());
  ASSERT_TRUE(odometry.finish().ok());
  const std::optional<RollingOdometry::Pose> first = odometry.take();
  ASSERT_TRUE(first);
  EXPECT_LT((first->pose.position_W_m - T_WG.translation()).norm(), 0.01);
}

}  // namespace
}  // namespace tumble
