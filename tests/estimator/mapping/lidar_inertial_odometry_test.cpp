// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;

constexpr int kSamplesPerSweep = 10;
constexpr double kNoise_m = 0.01;

Odometry::Params rig_params() {
  Odometry::Params params;
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  return params;
}

/// Sensor data of one tumble in the room, made once.
struct Tumble {
  test::Motion motion;
  std::vector<ImuSample> imu;
  std::vector<std::vector<LidarPoint>> sweeps;

  explicit Tumble(int count) : imu(test::make_imu(motion, 0.1 * count)) {
    for (int i = 0; i < count; ++i) {
      sweeps.push_back(test::make_sweep(test::Room::box_with_pillars(), motion, rig_params().T_IL, i, kNoise_m));
    }
  }
};

const Tumble& tumble() {
  static const Tumble data(26);
  return data;
}

/// A method that believes a gyro with a rail.
RateState clipped_rate(const ImuSample& sample, double rail_rad_s) {
  RateState rate = test::believe(sample);
  for (int axis = 0; axis < 3; ++axis) {
    double& w = rate.w_WI_I_rad_s[axis];
    if (std::abs(w) < rail_rad_s) continue;
    w = std::copysign(rail_rad_s, w);
    rate.clipped_axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return rate;
}

void feed_imu(Odometry& odometry, int sweep, double rail_rad_s = 1e9) {
  for (int k = sweep * kSamplesPerSweep; k < (sweep + 1) * kSamplesPerSweep; ++k) {
    const ImuSample& sample = tumble().imu[static_cast<std::size_t>(k)];
    ASSERT_TRUE(odometry.add_imu(sample, clipped_rate(sample, rail_rad_s)).ok());
  }
}

Status add_sweep(Odometry& odometry, int sweep, std::span<const LidarPoint> points, Odometry::SweepReport& report) {
  return odometry.add_sweep(sweep * test::kSweep_ns, (sweep + 1) * test::kSweep_ns, points, report);
}

struct Error {
  double m, rad, m_s;
};
Error error_of(const PoseState& pose) {
  const double t = 1e-9 * static_cast<double>(pose.time_ns);
  const test::Motion& motion = tumble().motion;
  return {(pose.p_WA_m - motion.p_m(t)).norm(), so3::log(pose.q_WA * motion.q(t).conjugate()).norm(),
          (pose.v_WA_m_s - motion.v_m_s(t)).norm()};
}

std::vector<Odometry::SweepReport> run(Odometry& odometry, int from, int to, double rail_rad_s = 1e9) {
  std::vector<Odometry::SweepReport> reports;
  for (int i = from; i < to; ++i) {
    feed_imu(odometry, i, rail_rad_s);
    const Status status = add_sweep(odometry, i, tumble().sweeps[static_cast<std::size_t>(i)], reports.emplace_back());
    EXPECT_TRUE(status.ok()) << status.message();
  }
  return reports;
}

bool same(const Odometry::SweepReport& a, const Odometry::SweepReport& b) {
  if (a.verdict != b.verdict || a.trajectory.size() != b.trajectory.size() || a.iterations != b.iterations)
    return false;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    const PoseState &p = a.trajectory[i], &q = b.trajectory[i];
    if (p.time_ns != q.time_ns || p.p_WA_m != q.p_WA_m || p.q_WA.coeffs() != q.q_WA.coeffs() ||
        p.v_WA_m_s != q.v_WA_m_s || p.covariance != q.covariance) {
      return false;
    }
  }
  return a.inlier_share == b.inlier_share && a.conditioning == b.conditioning &&
         a.map_points_added == b.map_points_added;
}

TEST(LidarInertialOdometry, FollowsATumbleThroughARoom) {
  Odometry odometry(rig_params());
  const auto reports = run(odometry, 0, 26);
  EXPECT_EQ(reports[0].verdict, SweepVerdict::first);
  int registered = 0;
  for (std::size_t i = 1; i < reports.size(); ++i) {
    // the map of a sensor at rest is rings; it fills once the spin begins
    EXPECT_NE(reports[i].verdict, SweepVerdict::rejected) << "sweep " << i;
    registered += reports[i].verdict == SweepVerdict::registered;
    EXPECT_GT(reports[i].inlier_share, i < 4 ? 0.15 : 0.35) << "sweep " << i;
    ASSERT_EQ(reports[i].trajectory.size(), static_cast<std::size_t>(kSamplesPerSweep));
    EXPECT_EQ(reports[i].trajectory.back().time_ns, static_cast<TimeNs>(i + 1) * test::kSweep_ns);
    EXPECT_LT(error_of(reports[i].pose).m, 0.05) << "sweep " << i;
  }
  EXPECT_GT(registered, 20);
  const Error end = error_of(reports.back().pose);
  // most of it comes from the first moving sweep against rings; measured 0.025 m, 0.0013 rad, 0.01 m/s
  EXPECT_LT(end.m, 0.04);
  EXPECT_LT(end.rad, 0.003);
  EXPECT_LT(end.m_s, 0.05);

  // the map lies on the surfaces, and its normals look back at the sensor's side of them
  const std::vector<MapPoint> map = odometry.map();
  ASSERT_GT(map.size(), 10'000u);
  std::size_t near = 0, with_normal = 0, inwards = 0;
  const test::Room room = test::Room::box();
  for (const MapPoint& point : map) {
    const Eigen::Vector3d p = point.position_W_m.cast<double>();
    near += test::Room::box_with_pillars().distance(p) < 0.1;
    if (point.normal_W.isZero()) continue;
    ++with_normal;
    EXPECT_NEAR(point.normal_W.norm(), 1.0f, 1e-5f);
    inwards += point.normal_W.cast<double>().dot(-p) > 0.0 || room.distance(p) > 0.2;  // pillars look outwards
  }
  EXPECT_GT(static_cast<double>(near) / static_cast<double>(map.size()), 0.98);
  EXPECT_GT(static_cast<double>(with_normal) / static_cast<double>(map.size()), 0.7);
  EXPECT_GT(static_cast<double>(inwards) / static_cast<double>(with_normal), 0.98);
}

TEST(LidarInertialOdometry, IsLostWithAClippedRate) {
  Odometry odometry(rig_params());
  const auto reports = run(odometry, 0, 26, 8.0);
  const Error end = error_of(reports.back().pose);
  EXPECT_GT(end.m + end.rad, 0.5);  // negative control of the test above
}

TEST(LidarInertialOdometry, FindsTheExcessOfClippedAxesByItself) {
  Odometry::Params params = rig_params();
  params.estimate_saturation_deficit = true;
  Odometry odometry(params);
  const auto reports = run(odometry, 0, 26, 8.0);
  const Error end = error_of(reports.back().pose);
  EXPECT_LT(end.m, 0.15);
  EXPECT_LT(end.rad, 0.02);
  EXPECT_GT(reports.back().saturation_deficit_rad_s.maxCoeff(), 1.0);
}

TEST(LidarInertialOdometry, RestartsBitByBitFromACopy) {
  Odometry whole(rig_params());
  const auto before = run(whole, 0, 9);
  // in the midst of a sweep's samples
  for (int k = 90; k < 94; ++k) {
    ASSERT_TRUE(whole
                    .add_imu(tumble().imu[static_cast<std::size_t>(k)],
                             test::believe(tumble().imu[static_cast<std::size_t>(k)]))
                    .ok());
  }
  Odometry copy(whole);
  Odometry assigned(rig_params());
  assigned = whole;
  for (Odometry* odometry : {&whole, &copy, &assigned}) {
    for (int k = 94; k < 100; ++k) {
      const ImuSample& sample = tumble().imu[static_cast<std::size_t>(k)];
      ASSERT_TRUE(odometry->add_imu(sample, test::believe(sample)).ok());
    }
  }
  for (int i = 9; i < 13; ++i) {
    Odometry::SweepReport a, b, c;
    ASSERT_TRUE(add_sweep(whole, i, tumble().sweeps[static_cast<std::size_t>(i)], a).ok());
    ASSERT_TRUE(add_sweep(copy, i, tumble().sweeps[static_cast<std::size_t>(i)], b).ok());
    ASSERT_TRUE(add_sweep(assigned, i, tumble().sweeps[static_cast<std::size_t>(i)], c).ok());
    EXPECT_TRUE(same(a, b)) << "sweep " << i;
    EXPECT_TRUE(same(a, c)) << "sweep " << i;
    EXPECT_FALSE(same(a, before.back())) << "the comparison is blind";
    if (i == 12) break;
    feed_imu(whole, i + 1);
    feed_imu(copy, i + 1);
    feed_imu(assigned, i + 1);
  }
}

TEST(LidarInertialOdometry, ReportsItsTroublesAndGoesOn) {
  Odometry odometry(rig_params());
  Odometry::SweepReport report;
  run(odometry, 0, 3);
  const std::vector<LidarPoint>& points = tumble().sweeps[3];

  // IMU samples do not reach the end; nothing changes
  EXPECT_EQ(add_sweep(odometry, 3, points, report).trouble, Trouble::too_few);
  feed_imu(odometry, 3);
  // times
  EXPECT_EQ(odometry.add_sweep(2 * test::kSweep_ns, 3 * test::kSweep_ns, points, report).trouble, Trouble::time_order);
  EXPECT_EQ(odometry.add_sweep(4 * test::kSweep_ns, 3 * test::kSweep_ns, points, report).trouble, Trouble::time_order);
  EXPECT_EQ(odometry.add_sweep(3 * test::kSweep_ns, 3 * test::kSweep_ns + 50'000'000, points, report).trouble,
            Trouble::out_of_range);
  EXPECT_EQ(report.verdict, SweepVerdict::rejected);
  const ImuSample& old = tumble().imu[5];
  EXPECT_EQ(odometry.add_imu(old, test::believe(old)).trouble, Trouble::time_order);
  ImuSample next = tumble().imu[40];
  RateState other = test::believe(next);
  other.time_ns += 1;
  EXPECT_EQ(odometry.add_imu(next, other).trouble, Trouble::out_of_range);
  other = test::believe(next);
  other.w_WI_I_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_imu(next, other).trouble, Trouble::non_finite);
  next.specific_force_m_s2.y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(odometry.add_imu(next, test::believe(tumble().imu[40])).trouble, Trouble::non_finite);

  // after all of this the sweep registers as if nothing had been
  ASSERT_TRUE(add_sweep(odometry, 3, points, report).ok());
  EXPECT_NE(report.verdict, SweepVerdict::rejected);
  Odometry untroubled(rig_params());
  EXPECT_TRUE(same(report, run(untroubled, 0, 4).back()));
}

struct BadSweep {
  const char* name;
  Trouble trouble;
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
    Odometry::SweepReport report;
    const Status status = add_sweep(odometry, i, GetParam().make(tumble().sweeps[static_cast<std::size_t>(i)]), report);
    EXPECT_EQ(status.trouble, GetParam().trouble) << status.message();
    EXPECT_EQ(report.verdict, SweepVerdict::rejected);
    EXPECT_EQ(report.map_points_added, 0u);
    EXPECT_EQ(report.pose.time_ns, (i + 1) * test::kSweep_ns);
    ASSERT_EQ(report.trajectory.size(), static_cast<std::size_t>(kSamplesPerSweep));
    EXPECT_TRUE(report.pose.p_WA_m.allFinite());
    EXPECT_LT(error_of(report.pose).m, 0.3) << "dead reckoning over 0.3 s";
    EXPECT_GT(std::sqrt(report.pose.covariance(0, 0)), i == 8 ? 0.01 : 0.02);
  }
  EXPECT_EQ(odometry.map().size(), before);
  // and finds its way back
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
                         testing::Values(BadSweep{"empty", Trouble::empty, nothing},
                                         BadSweep{"nan", Trouble::non_finite, all_nan},
                                         BadSweep{"equal_offsets", Trouble::degenerate, equal_offsets},
                                         BadSweep{"covered", Trouble::too_few, covered},
                                         BadSweep{"a_handful", Trouble::none, a_handful}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(LidarInertialOdometry, TreatsNanReturnsAsMisses) {
  Odometry clean(rig_params()), with_nan(rig_params());
  feed_imu(clean, 0);
  feed_imu(with_nan, 0);
  std::vector<LidarPoint> points = tumble().sweeps[0];
  Odometry::SweepReport a, b;
  ASSERT_TRUE(add_sweep(clean, 0, points, a).ok());
  LidarPoint miss;
  miss.position_L_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < 100; ++i) points.insert(points.begin() + 37 * i, miss);
  ASSERT_TRUE(add_sweep(with_nan, 0, points, b).ok());
  EXPECT_EQ(a.points_used, b.points_used);
  EXPECT_EQ(a.map_points_added, b.map_points_added);
}

TEST(LidarInertialOdometry, SaysThatAFloorAloneDoesNotHoldIt) {
  Odometry odometry(rig_params());
  int degenerate = 0;
  for (int i = 0; i < 10; ++i) {
    feed_imu(odometry, i);
    const auto points = test::make_sweep(test::Room::floor_only(), tumble().motion, rig_params().T_IL, i, kNoise_m);
    Odometry::SweepReport report;
    ASSERT_TRUE(add_sweep(odometry, i, points, report).ok());
    EXPECT_NE(report.verdict, SweepVerdict::registered) << "sweep " << i << " conditioning " << report.conditioning;
    if (report.verdict != SweepVerdict::degenerate || report.conditioning == 0.0) continue;
    ++degenerate;
    const auto& d = report.weakest_direction;
    EXPECT_GT(std::hypot(d[0], d[1], d[5]), 0.95) << d.transpose();
  }
  EXPECT_GT(degenerate, 3);  // at rest its rings give no plane at all
}

/// A plane without noise leaves directions open to the last bit: smallest over largest eigenvalue is 0 then. What it
/// does hold is aligned all the same.
TEST(LidarInertialOdometry, AnExactlyDegenerateAlignmentCounts) {
  const auto plane = [](float height_m) {
    std::vector<LidarPoint> points;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        LidarPoint& point = points.emplace_back();
        point.position_L_m = {0.25f * static_cast<float>(i), 0.25f * static_cast<float>(j), height_m};
        point.offset_ns = static_cast<TimeNs>(points.size()) * 10'000;
        point.ring = static_cast<std::uint16_t>(i + 40);
      }
    }
    return points;
  };
  Odometry::Params params;
  params.T_IL.setIdentity();
  Odometry odometry(params);
  Odometry::SweepReport report;
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int k = sweep * kSamplesPerSweep; k < (sweep + 1) * kSamplesPerSweep; ++k) {
      ImuSample sample;
      sample.time_ns = (k + 1) * test::kSweep_ns / kSamplesPerSweep;
      sample.angular_velocity_rad_s = {0.0, 0.0, sweep == 0 ? 0.0 : 0.5};  // no rest, about the plane's normal
      sample.specific_force_m_s2 = {0.0, 0.0, params.gravity_m_s2};
      ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    // the second sweep sees the plane 5 mm nearer than inertia has it
    ASSERT_TRUE(add_sweep(odometry, sweep, plane(sweep == 0 ? -1.5f : -1.495f), report).ok());
  }
  EXPECT_EQ(report.verdict, SweepVerdict::degenerate);
  EXPECT_EQ(report.conditioning, 0.0);
  EXPECT_GT(report.iterations, 0);
  EXPECT_NEAR(report.pose.p_WA_m.z(), -0.005, 0.002);
  EXPECT_GT(report.innovation, 0.0);
}

/// Above a floor alone, which leaves two directions open, and with an accelerometer that is off by 0.5 m/s^2 once the
/// rest is over: integrated it goes astray, a velocity that is told at every sweep holds it.
TEST(LidarInertialOdometry, AVelocityThatIsToldHoldsWhatTheSurfacesDoNot) {
  const test::Motion& motion = tumble().motion;
  const auto end_error_m = [&](bool told) {
    Odometry odometry(rig_params());
    Odometry::SweepReport report;
    for (int i = 0; i < 12; ++i) {
      for (int k = i * kSamplesPerSweep; k < (i + 1) * kSamplesPerSweep; ++k) {
        ImuSample sample = tumble().imu[static_cast<std::size_t>(k)];
        const double t = seconds(sample.time_ns);
        if (t > motion.rest_s) sample.specific_force_m_s2 += motion.q(t).conjugate() * Eigen::Vector3d(0.5, 0.0, 0.0);
        EXPECT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
      }
      const double start_s = 0.1 * i;
      const Eigen::Vector3d v_I_m_s = motion.q(start_s).conjugate() * motion.v_m_s(start_s);
      if (told) {
        EXPECT_TRUE(odometry.add_velocity(v_I_m_s, 0.01).ok());
      }
      const auto points = test::make_sweep(test::Room::floor_only(), motion, rig_params().T_IL, i, kNoise_m);
      EXPECT_TRUE(add_sweep(odometry, i, points, report).ok());
    }
    return error_of(report.pose).m;
  };
  EXPECT_LT(end_error_m(true), 0.1);
  EXPECT_GT(end_error_m(false), 0.15);
}

TEST(LidarInertialOdometry, RefusesAVelocityThatSaysNothing) {
  Odometry odometry(rig_params());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_velocity({nan, 0.0, 0.0}, 0.01).trouble, Trouble::non_finite);
  EXPECT_EQ(odometry.add_velocity({0.0, 0.0, 0.0}, nan).trouble, Trouble::non_finite);
  EXPECT_EQ(odometry.add_velocity({0.0, 0.0, 0.0}, 0.0).trouble, Trouble::out_of_range);
}

TEST(LidarInertialOdometry, MissingImuIsATroubleNotAGuess) {
  Odometry odometry(rig_params());
  Odometry::SweepReport report;
  EXPECT_EQ(add_sweep(odometry, 0, tumble().sweeps[0], report).trouble, Trouble::too_few);
  EXPECT_EQ(report.verdict, SweepVerdict::rejected);
  EXPECT_TRUE(odometry.map().empty());
}

TEST(LidarInertialOdometry, LevelsAtRest) {
  // a tilted start: gravity tells roll and pitch, yaw is zero
  const Eigen::Quaterniond q_true = so3::exp({0.0, 0.3, 0.0}) * so3::exp({0.2, 0.0, 0.0});
  Odometry odometry(rig_params());
  for (int k = 1; k <= 10; ++k) {
    ImuSample sample;
    sample.time_ns = k * 10'000'000;
    sample.specific_force_m_s2 = q_true.conjugate() * Eigen::Vector3d(0, 0, 9.80665);
    ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
  }
  Odometry::SweepReport report;
  ASSERT_TRUE(add_sweep(odometry, 0, tumble().sweeps[0], report).ok());
  EXPECT_LT(so3::log(report.pose.q_WA * q_true.conjugate()).norm(), 1e-12);
  EXPECT_LT(report.pose.p_WA_m.norm(), 1e-12);
}

TEST(LidarInertialOdometry, ThrowsOnBadParams) {
  Odometry::Params params;
  params.neighbours = 100;
  EXPECT_THROW(Odometry{params}, InvalidParams);
  params = {};
  params.T_IL.linear() *= 1.1;
  EXPECT_THROW(Odometry{params}, InvalidParams);
  params = {};
  params.prior_sigma_rad = 0.0;
  EXPECT_THROW(Odometry{params}, InvalidParams);
}

}  // namespace
}  // namespace tumble
