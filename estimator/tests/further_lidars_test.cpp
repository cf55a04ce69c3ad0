// SPDX-License-Identifier: BSD-3-Clause
// The tests split the sweeps of one lidar into the sweeps of two lidars. The lidars differ in mounting, clock and
// phase.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace further_lidars {

using test::ThrownBody;

constexpr TimeNs kClock_ns = 30'000'000;  // the second lidar's clock is behind the first lidar's clock by this time
const Eigen::Isometry3d kT_I2 =
    Eigen::Translation3d(0.2, -0.1, 0.3) * Eigen::Isometry3d(Eigen::AngleAxisd(so3::exp({0.3, -0.5, 2.0})));

/// Returns the points of rings 8 and above if `upper` is true, and otherwise the points of rings below 8.
std::vector<LidarPoint> half(const std::vector<LidarPoint>& points, bool upper) {
  std::vector<LidarPoint> out;
  for (const LidarPoint& point : points)
    if ((point.ring >= 8) == upper) out.push_back(point);
  return out;
}

TumblingOdometry::Params two_lidars(const ThrownBody& body, const Eigen::Isometry3d& T_I2) {
  TumblingOdometry::Params params = test::params_of(body);
  FurtherLidar& second = params.further_lidars.emplace_back();
  second.T_IL = T_I2;
  second.first_minus_this_clock_s = seconds(kClock_ns);
  return params;
}

struct Outcome {
  std::vector<SweepResult> sweeps;
  double worst_m = 0.0;
};

enum class Points { all, lower_half, both_halves };

Outcome run(const ThrownBody& body, TumblingOdometry& odometry, Points use) {
  Outcome out;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  // the second lidar has the same rays, but its sweeps begin in the middle of the first lidar's sweeps
  std::vector<ThrownBody::Sweep> second;
  for (std::size_t k = 0; k + 1 < sweeps.size(); ++k) {
    const TimeNs start_ns = (sweeps[k].start_ns + sweeps[k].end_ns) / 2,
                 end_ns = (sweeps[k + 1].start_ns + sweeps[k + 1].end_ns) / 2;
    ThrownBody::Sweep& added = second.emplace_back(ThrownBody::Sweep{start_ns - kClock_ns, end_ns - kClock_ns, {}});
    for (const ThrownBody::Sweep* from : {&sweeps[k], &sweeps[k + 1]}) {
      for (LidarPoint point : half(from->points, true)) {
        const TimeNs time_ns = from->start_ns + point.offset_ns;
        if (time_ns < start_ns || time_ns >= end_ns) continue;
        point.position_L_m = kT_I2.inverse().cast<float>() * point.position_L_m;
        point.offset_ns = static_cast<std::uint32_t>(time_ns - start_ns);
        added.points.push_back(point);
      }
    }
  }
  const auto take = [&] {
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      const PoseState& pose = sweep->result.pose;
      out.worst_m = std::max(out.worst_m, (pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation()).norm());
      out.sweeps.push_back(sweep->result);
    }
  };
  auto first = sweeps.begin();
  auto further = second.begin();
  for (const ImuSample& sample : body.imu()) {
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    for (; use == Points::both_halves && further != second.end() && further->end_ns + kClock_ns <= sample.time_ns;
         ++further)
      EXPECT_TRUE(odometry.add_sweep(1, further->start_ns, further->end_ns, further->points).ok());
    for (; first != sweeps.end() && first->end_ns <= sample.time_ns; ++first) {
      const std::vector<LidarPoint> points = use == Points::all ? first->points : half(first->points, false);
      EXPECT_TRUE(odometry.add_sweep(0, first->start_ns, first->end_ns, points).ok());
    }
    take();
  }
  EXPECT_TRUE(odometry.finish().ok());
  take();
  return out;
}

TEST(FurtherLidars, PointsJoinTheSweepAtTheirTime) {
  const ThrownBody body;
  for (const double lag_s : {0.2, TumblingOdometry::kWholeRecording}) {
    TumblingOdometry::Params of_one = test::params_of(body), of_two = two_lidars(body, kT_I2);
    of_one.lag_s = of_two.lag_s = lag_s;
    TumblingOdometry whole(of_one), lower(of_one), both(of_two);
    const Outcome of_whole = run(body, whole, Points::all), of_lower = run(body, lower, Points::lower_half),
                  of_both = run(body, both, Points::both_halves);
    ASSERT_EQ(of_both.sweeps.size(), of_whole.sweeps.size());
    for (std::size_t k = 1; k + 2 < of_both.sweeps.size(); ++k) {  // the second lidar starts later and ends earlier
      // the point counts may differ, because points at the border of two sweeps may join either sweep, and because of
      // points near the range limits
      EXPECT_NEAR(double(of_both.sweeps[k].usable_points), double(of_whole.sweeps[k].usable_points), 20.0) << k;
      EXPECT_LT(of_lower.sweeps[k].usable_points, 0.6 * double(of_whole.sweeps[k].usable_points)) << "negative control";
    }
    EXPECT_LT(of_both.worst_m, of_whole.worst_m + 0.01);
  }
}

TEST(FurtherLidars, AWrongMountingDoesHarm) {
  const ThrownBody body;
  TumblingOdometry good(two_lidars(body, kT_I2)), wrong(two_lidars(body, Eigen::Translation3d(0.0, 0.5, 0.0) * kT_I2));
  EXPECT_LT(run(body, good, Points::both_halves).worst_m, 0.5 * run(body, wrong, Points::both_halves).worst_m);
}

TEST(FurtherLidars, ALoadedRunKeepsTheMountingRelativeToTheFirst) {
  const ThrownBody body;
  TumblingOdometry::Params params = two_lidars(body, kT_I2);
  TumblingOdometry first(params);
  EXPECT_LT(run(body, first, Points::both_halves).worst_m, 0.1);
  TumblingOdometry loaded(params);
  const Status status = loaded.load(first.save());
  ASSERT_TRUE(status.ok()) << status.message();
  loaded.reset(body.T_WI(0.0));
  EXPECT_LT(run(body, loaded, Points::both_halves).worst_m, 0.1);
}

TEST(FurtherLidars, WrongInputIsRejected) {
  const ThrownBody body;
  TumblingOdometry::Params params = two_lidars(body, kT_I2);
  TumblingOdometry odometry(params);
  const ThrownBody::Sweep sweep = body.sweeps().front();
  EXPECT_EQ(odometry.add_sweep(2, sweep.start_ns, sweep.end_ns, sweep.points).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_sweep(1, sweep.end_ns, sweep.start_ns, sweep.points).error_code, ErrorCode::time_order);
  EXPECT_EQ(odometry.add_sweep(1, sweep.start_ns, sweep.start_ns + 1, sweep.points).error_code,
            ErrorCode::out_of_range);
  params.further_lidars[0].first_minus_this_clock_s = 2.0;
  EXPECT_THROW(TumblingOdometry{params}, InvalidParams);
  params = two_lidars(body, kT_I2);
  params.further_lidars[0].T_IL.linear() *= 2.0;
  EXPECT_THROW(TumblingOdometry{params}, InvalidParams);
}

}  // namespace further_lidars
}  // namespace tumble
