// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/room_tumble.hpp"
#include "tests/testing.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;
using test::add_sweep;
using test::error_of;
using test::feed_imu;
using test::kSamplesPerSweep;
using test::rig_params;
using test::run;
using test::same;

TEST(LidarInertialOdometry, ReportsItsTroublesAndGoesOn) {
  Odometry odometry(rig_params());
  Odometry::SweepResult report;
  run(odometry, 0, 3);
  const std::vector<LidarPoint>& points = test::room_tumble().sweeps[3];

  // the IMU samples end too early; the state is unchanged
  EXPECT_EQ(add_sweep(odometry, 3, points, report).error_code, ErrorCode::insufficient_data);
  feed_imu(odometry, 3);
  // invalid times
  EXPECT_EQ(odometry.add_sweep(2 * test::kSweep_ns, 3 * test::kSweep_ns, points, report).error_code,
            ErrorCode::time_order);
  EXPECT_EQ(odometry.add_sweep(4 * test::kSweep_ns, 3 * test::kSweep_ns, points, report).error_code,
            ErrorCode::time_order);
  EXPECT_EQ(odometry.add_sweep(3 * test::kSweep_ns, 3 * test::kSweep_ns + 50'000'000, points, report).error_code,
            ErrorCode::out_of_range);
  EXPECT_EQ(report.verdict, SweepVerdict::rejected);
  const ImuSample& old = test::room_tumble().imu[5];
  EXPECT_EQ(odometry.add_imu(old, test::believe(old)).error_code, ErrorCode::time_order);
  ImuSample next = test::room_tumble().imu[40];
  AngularRateState other = test::believe(next);
  other.time_ns += 1;
  EXPECT_EQ(odometry.add_imu(next, other).error_code, ErrorCode::out_of_range);
  other = test::believe(next);
  other.w_WI_I_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_imu(next, other).error_code, ErrorCode::non_finite);
  next.specific_force_m_s2.y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(odometry.add_imu(next, test::believe(test::room_tumble().imu[40])).error_code, ErrorCode::non_finite);

  // after all these errors, the sweep registers as usual
  ASSERT_TRUE(add_sweep(odometry, 3, points, report).ok());
  EXPECT_NE(report.verdict, SweepVerdict::rejected);
  Odometry untroubled(rig_params());
  EXPECT_TRUE(same(report, run(untroubled, 0, 4).back()));
}

struct BadSweep {
  const char* name;
  ErrorCode error_code;
  std::vector<LidarPoint> (*make)(std::vector<LidarPoint>);
};
void PrintTo(const BadSweep& bad, std::ostream* out) {
  *out << bad.name;
}
class UselessSweep : public testing::TestWithParam<BadSweep> {};

TEST_P(UselessSweep, KeepsTheInertialPriorAndSaysSo) {
  Odometry odometry(rig_params());
  run(odometry, 0, 8);
  const std::size_t before = odometry.map().size();
  for (int i = 8; i < 11; ++i) {
    feed_imu(odometry, i);
    Odometry::SweepResult report;
    const Status status =
        add_sweep(odometry, i, GetParam().make(test::room_tumble().sweeps[static_cast<std::size_t>(i)]), report);
    EXPECT_EQ(status.error_code, GetParam().error_code) << status.message();
    EXPECT_EQ(report.verdict, SweepVerdict::rejected);
    EXPECT_EQ(report.map_points_added, 0u);
    EXPECT_EQ(report.pose.time_ns, (i + 1) * test::kSweep_ns);
    ASSERT_EQ(report.trajectory.size(), static_cast<std::size_t>(kSamplesPerSweep));
    EXPECT_TRUE(report.pose.position_W_m.allFinite());
    EXPECT_LT(error_of(report.pose).m, 0.3) << "dead reckoning over 0.3 s";
    EXPECT_GT(std::sqrt(report.pose.covariance(0, 0)), i == 8 ? 0.01 : 0.02);
  }
  EXPECT_EQ(odometry.map().size(), before);
  // and the run relocalises
  const auto after = run(odometry, 11, 16);
  EXPECT_EQ(after.back().verdict, SweepVerdict::registered);
  EXPECT_LT(error_of(after.back().pose).m, 0.05);
}

std::vector<LidarPoint> nothing(std::vector<LidarPoint>) {
  return {};
}
std::vector<LidarPoint> all_nan(std::vector<LidarPoint> points) {
  for (LidarPoint& p : points) p.position_L_m.x() = std::numeric_limits<float>::quiet_NaN();
  return points;
}
std::vector<LidarPoint> equal_offsets(std::vector<LidarPoint> points) {
  for (LidarPoint& p : points) p.offset_ns = 0;
  return points;
}
std::vector<LidarPoint> covered(std::vector<LidarPoint> points) {
  for (LidarPoint& p : points) p.position_L_m *= 0.1f / p.position_L_m.norm();
  return points;
}
std::vector<LidarPoint> a_handful(std::vector<LidarPoint> points) {
  points.resize(20);
  return points;
}
INSTANTIATE_TEST_SUITE_P(Sweeps, UselessSweep,
                         testing::Values(BadSweep{"empty", ErrorCode::empty, nothing},
                                         BadSweep{"nan", ErrorCode::non_finite, all_nan},
                                         BadSweep{"equal_offsets", ErrorCode::degenerate, equal_offsets},
                                         BadSweep{"covered", ErrorCode::insufficient_data, covered},
                                         BadSweep{"a_handful", ErrorCode::none, a_handful}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(LidarInertialOdometry, TreatsNanReturnsAsMisses) {
  Odometry clean(rig_params()), with_nan(rig_params());
  feed_imu(clean, 0);
  feed_imu(with_nan, 0);
  std::vector<LidarPoint> points = test::room_tumble().sweeps[0];
  Odometry::SweepResult a, b;
  ASSERT_TRUE(add_sweep(clean, 0, points, a).ok());
  LidarPoint miss;
  miss.position_L_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < 100; ++i) points.insert(points.begin() + 37 * i, miss);
  ASSERT_TRUE(add_sweep(with_nan, 0, points, b).ok());
  EXPECT_EQ(a.usable_points, b.usable_points);
  EXPECT_EQ(a.map_points_added, b.map_points_added);
}

TEST(LidarInertialOdometry, MissingImuIsATroubleNotAGuess) {
  Odometry odometry(rig_params());
  Odometry::SweepResult report;
  EXPECT_EQ(add_sweep(odometry, 0, test::room_tumble().sweeps[0], report).error_code, ErrorCode::insufficient_data);
  EXPECT_EQ(report.verdict, SweepVerdict::rejected);
  EXPECT_TRUE(odometry.map().empty());
}

TEST(LidarInertialOdometry, ThrowsOnBadParams) {
  Odometry::Params params;
  params.expert.matching.distance_m = 100.0;
  EXPECT_THROW(Odometry{params}, InvalidParams);
  params = {};
  params.T_IL.linear() *= 1.1;
  EXPECT_THROW(Odometry{params}, InvalidParams);
  params = {};
  params.T_IL.linear().col(0) *= -1.0;
  EXPECT_THROW(Odometry{params}, InvalidParams) << "mirrored axes";
  params = {};
  params.expert.prior.sigma_rad = 0.0;
  EXPECT_THROW(Odometry{params}, InvalidParams);
}

TEST(LidarInertialOdometry, BadParamsAreReportedAsAValueToo) {
  EXPECT_TRUE(check_odometry_params({}).ok());
  const auto told = [](auto change) {
    Odometry::Params params;
    change(params);
    const Status status = check_odometry_params(params);
    EXPECT_EQ(status.error_code, ErrorCode::out_of_range) << status.field;
    EXPECT_THROW(Odometry{params}, InvalidParams) << status.field;
    return std::string(status.field);
  };
  EXPECT_EQ(told([](Odometry::Params& p) { p.mount_sigma_m = std::nan(""); }), "mount_sigma_m");
  EXPECT_EQ(told([](Odometry::Params& p) { p.expert.prior.sigma_rad = 0.0; }), "prior_sigma_rad");
  EXPECT_EQ(told([](Odometry::Params& p) { p.range_max_m = 0.1; }), "range_max_m");
  EXPECT_EQ(told([](Odometry::Params& p) { p.T_IL.translation().x() = 2e3; }), "T_IL translation");
  EXPECT_EQ(told([](Odometry::Params& p) { p.T_IL.linear() *= 1.1; }), "T_IL rotation's distance from orthogonal");
  EXPECT_EQ(told([](Odometry::Params& p) {
              p.own_body_L = {Eigen::Vector3d::Ones(), -Eigen::Vector3d::Ones()};
            }),
            "own_body_L maximum x minus minimum x");
}

}  // namespace
}  // namespace tumble
