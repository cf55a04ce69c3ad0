// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/published_chain.hpp"

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble::baselines {
namespace {

constexpr TimeNs kStep_ns = 10'000'000;

/// Returns samples of an IMU that is level, at rest for the first sample and then accelerated along x by 1 m/s^2, at
/// 100 Hz.
std::vector<ImuSample> accelerated(int count) {
  std::vector<ImuSample> samples(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    ImuSample& sample = samples[static_cast<std::size_t>(k)];
    sample.time_ns = k * kStep_ns;
    sample.angular_velocity_rad_s.setZero();
    sample.specific_force_m_s2 = {k == 0 ? 0.0 : 1.0, 0.0, test::kRoomGravity_m_s2};
  }
  return samples;
}

TEST(PublishedImuOdometry, StaysUntilAVelocityIsFedBackAndIntegratesTheForceFromThere) {
  const std::vector<ImuSample> samples = accelerated(30);
  const std::vector<AngularRateState> rates(samples.size());
  PublishedImuOdometry odometry(0.0, samples, rates);
  odometry.advance(10 * kStep_ns);
  EXPECT_EQ(odometry.pose(10 * kStep_ns).translation(), Eigen::Vector3d::Zero());
  odometry.feed_back({2.0, 0.0, 0.0}, 10 * kStep_ns);
  odometry.advance(20 * kStep_ns);
  // the expected distance is v t + a t^2 / 2 over 0.1 s
  EXPECT_NEAR(odometry.pose(20 * kStep_ns).translation().x(), 0.205, 1e-9);
  EXPECT_NEAR(odometry.velocity_m_s(20 * kStep_ns).x(), 2.1, 1e-9);
  // a pose of 50 ms ago is fed back: the odometry adds the motion since then again
  odometry.feed_back({5.0, 0.0, 0.0}, 15 * kStep_ns);
  odometry.advance(21 * kStep_ns);
  EXPECT_NEAR(odometry.velocity_m_s(21 * kStep_ns).x(), 5.06, 1e-9);
  // the odometry gives poses between samples, and no pose beyond the last integrated sample
  EXPECT_NEAR(odometry.pose(5 * kStep_ns / 2 + 15 * kStep_ns).translation().x(),
              0.5 * (odometry.pose(17 * kStep_ns).translation().x() + odometry.pose(18 * kStep_ns).translation().x()),
              1e-12);
  EXPECT_EQ(odometry.pose(29 * kStep_ns).translation(), odometry.pose(21 * kStep_ns).translation());
}

struct InARoom {
  test::Motion motion;
  std::vector<ImuSample> samples;
  std::vector<AngularRateState> rates;
  std::vector<std::vector<LidarPoint>> sweeps;
};

/// Returns a motion so gentle that the chain's own errors are small.
InARoom gentle(int sweeps) {
  InARoom out;
  out.motion.spin_rad_s = 0.5;
  out.motion.second_spin_rad_s = 0.2;
  out.motion.swing = 0.1;
  out.samples = test::make_imu(out.motion, 0.1 * sweeps + 0.1);
  for (const ImuSample& sample : out.samples) out.rates.push_back(test::believe(sample));
  for (int k = 0; k < sweeps; ++k)
    out.sweeps.push_back(
        test::make_sweep(test::Room::box_with_pillars(), out.motion, Eigen::Isometry3d::Identity(), k));
  return out;
}

TEST(PublishedChain, FollowsAGentleMotionAndDrawsItsMap) {
  const InARoom room = gentle(15);
  PublishedChain chain({}, room.samples, room.rates);
  std::vector<PublishedChain::SweepResult> reports;
  for (std::size_t k = 0; k < room.sweeps.size(); ++k) {
    const TimeNs start_ns = static_cast<TimeNs>(k) * test::kSweep_ns;
    const PublishedChain::Sweep sweep{start_ns, start_ns + test::kSweep_ns, room.sweeps[k]};
    ASSERT_TRUE(chain.covers(sweep)) << k;
    ASSERT_TRUE(chain.add(sweep, reports.emplace_back()).ok()) << k;
    EXPECT_EQ(reports.back().verdict, k == 0 ? SweepVerdict::first : SweepVerdict::registered) << k;
  }
  const auto pose = [](const PoseState& state) {
    return Isometry3d(Eigen::Translation3d(state.position_W_m) * state.orientation_W);
  };
  const Isometry3d moved = pose(reports.front().pose).inverse() * pose(reports.back().pose);
  const Isometry3d truly = room.motion.pose(0.1).inverse() * room.motion.pose(0.1 * 15);
  EXPECT_GT(truly.translation().norm(), 0.1) << "or nothing was asked";
  EXPECT_LT((moved.translation() - truly.translation()).norm(), 0.05);
  EXPECT_GT(chain.map().size(), 1000u);
}

TEST(PublishedChain, ReportsASweepWithoutPointsToRegister) {
  const InARoom room = gentle(3);
  PublishedChain chain({}, room.samples, room.rates);
  PublishedChain::SweepResult report;
  EXPECT_EQ(chain.add({0, test::kSweep_ns, {}}, report).error_code, ErrorCode::empty);
  EXPECT_FALSE(report.trajectory.empty()) << "the odometry goes on alone";
  std::vector<LidarPoint> points = room.sweeps[1];
  for (LidarPoint& point : points) point.offset_ns = 7;
  EXPECT_EQ(chain.add({test::kSweep_ns, 2 * test::kSweep_ns, points}, report).error_code, ErrorCode::degenerate);
  points = room.sweeps[2];
  for (LidarPoint& point : points) point.position_L_m *= 0.001f;
  EXPECT_EQ(chain.add({2 * test::kSweep_ns, 3 * test::kSweep_ns, points}, report).error_code,
            ErrorCode::insufficient_data);
  points.front().offset_ns = static_cast<std::uint32_t>(test::kSweep_ns + 1);
  EXPECT_EQ(chain.add({2 * test::kSweep_ns, 3 * test::kSweep_ns, points}, report).error_code, ErrorCode::out_of_range);
  EXPECT_FALSE(chain.covers({3 * test::kSweep_ns, 9 * test::kSweep_ns, {}}));
}

TEST(PublishedChain, LeavesOutTheRobotItself) {
  const InARoom room = gentle(1);
  PublishedChain::Params params;
  params.own_body_L = {Eigen::Vector3d::Constant(-100.0), Eigen::Vector3d::Constant(100.0)};
  PublishedChain chain(params, room.samples, room.rates);
  PublishedChain::SweepResult report;
  EXPECT_EQ(chain.add({0, test::kSweep_ns, room.sweeps[0]}, report).error_code, ErrorCode::insufficient_data);
  params.sweep_voxel_m = 0.0;
  EXPECT_THROW(PublishedChain(params, room.samples, room.rates), InvalidParams);
}

}  // namespace
}  // namespace tumble::baselines
