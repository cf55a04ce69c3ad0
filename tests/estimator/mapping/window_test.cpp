// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

// sweeps refined together with later ones, the trajectory at any time, and the caller's threads
namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;

using test::kSamplesPerSweep;

constexpr double kRail_rad_s = 8.0;

Odometry::Params given() {
  Odometry::Params params;
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  params.expert.saturated_imu.estimate_deficit = true;
  return params;
}

/// Returns a saturated gyro reading with an unknown rate.
AngularRateState railed(const ImuSample& sample) {
  AngularRateState rate = test::believe(sample);
  for (int axis = 0; axis < 3; ++axis) {
    double& w = rate.w_WI_I_rad_s[axis];
    if (std::abs(w) < kRail_rad_s) continue;
    w = std::copysign(kRail_rad_s, w);
    rate.clipped_axes |= static_cast<std::uint8_t>(1 << axis);
    rate.source = AngularRateSource::lower_bound_only;
  }
  return rate;
}

struct Drive {
  explicit Drive(const Odometry::Params& params) : odometry(params) {}

  /// Adds sweeps [from, to); those in [covered_from, covered_to) see nothing.
  void sweeps(int from, int to, int covered_from = 0, int covered_to = 0) {
    for (int k = from; k < to; ++k) {
      const bool covered = k >= covered_from && k < covered_to;
      for (int j = k * kSamplesPerSweep; j < (k + 1) * kSamplesPerSweep; ++j) {
        const ImuSample& sample = imu[static_cast<std::size_t>(j)];
        ASSERT_TRUE(odometry.add_imu(sample, railed(sample)).ok());
      }
      std::vector<LidarPoint> points;
      if (!covered) {
        points = test::make_sweep(test::Room::box_with_pillars(), motion, given().T_IL, k, test::kRoomNoise_m,
                                  test::kHalfColumns);
      }
      const Status status = odometry.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, report);
      ASSERT_EQ(status.error_code, covered ? ErrorCode::empty : ErrorCode::none) << status.message();
      reports.push_back(report);
    }
  }
  double error_m(const PoseState& pose) const {
    return (pose.position_W_m - motion.p_m(1e-9 * static_cast<double>(pose.time_ns))).norm();
  }

  double error_rad(const PoseState& pose) const {
    return so3::logarithm(pose.orientation_W * motion.q(1e-9 * static_cast<double>(pose.time_ns)).conjugate()).norm();
  }

  Odometry odometry;
  Odometry::SweepResult report;
  std::vector<Odometry::SweepResult> reports;
  test::Motion motion;
  std::vector<ImuSample> imu = test::make_imu(motion, 3.0);
};

TEST(Window, TheSweepsAfterItPlaceASweepThatSawNothing) {
  Odometry::Params params = given();
  params.expert.window_sweeps = 3;
  Drive run(params);
  run.sweeps(0, 15);
  run.sweeps(15, 18, 15, 16);  // only a clipped gyro
  run.sweeps(18, 19);
  const PoseState& at_once = run.reports[15].trajectory.back();
  const PoseState& smoothed = run.reports[17].final_poses_of_earlier_sweep.back();
  ASSERT_EQ(at_once.time_ns, smoothed.time_ns);
  EXPECT_LT(run.error_rad(smoothed), 0.5 * run.error_rad(at_once));
  EXPECT_LT(smoothed.covariance.diagonal().tail<3>().sum(), at_once.covariance.diagonal().tail<3>().sum());
  EXPECT_LT(run.error_m(run.report.pose), 0.05);
}

TEST(Window, OfOneLeavesASweepAsItWas) {
  Odometry::Params params = given();
  params.expert.window_sweeps = 1;
  Drive run(params);
  run.sweeps(0, 12);
  for (std::size_t k = 0; k < run.reports.size(); ++k) {
    const std::vector<PoseState>& smoothed = run.reports[k].final_poses_of_earlier_sweep;
    const std::vector<PoseState>& before = run.reports[k].trajectory;
    ASSERT_EQ(smoothed.size(), before.size());
    for (std::size_t i = 0; i < smoothed.size(); ++i) {
      EXPECT_EQ(smoothed[i].time_ns, before[i].time_ns);
      EXPECT_EQ(smoothed[i].position_W_m, before[i].position_W_m);
    }
  }
}

TEST(Window, SettledAndOpenSweepsAreTheWholeTrajectory) {
  Odometry::Params params = given();
  params.expert.window_sweeps = 4;
  Drive run(params);
  run.sweeps(0, 12);
  std::vector<PoseState> all;
  for (const Odometry::SweepResult& report : run.reports) {
    all.insert(all.end(), report.final_poses_of_earlier_sweep.begin(), report.final_poses_of_earlier_sweep.end());
  }
  EXPECT_EQ(all.back().time_ns, 9 * test::kSweep_ns);
  const auto open = run.odometry.window_trajectories();
  ASSERT_EQ(open.size(), 3u);
  for (const auto& sweep : open) all.insert(all.end(), sweep.begin(), sweep.end());
  ASSERT_EQ(all.size(), 120u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i].time_ns - all[i - 1].time_ns, 10'000'000) << i;
  // the newest state is that of the filter
  EXPECT_EQ(open.back().back().position_W_m, run.report.trajectory.back().position_W_m);
}

TEST(Window, APoseAheadIsTheInertialPriorAndChangesNothing) {
  Drive run(given());
  PoseState pose;
  EXPECT_EQ(run.odometry.predict({}, {}, pose).error_code, ErrorCode::empty);
  run.sweeps(0, 12);
  std::vector<ImuSample> ahead;
  std::vector<AngularRateState> rates;
  for (const ImuSample& sample : run.imu) {
    if (sample.time_ns <= 12 * test::kSweep_ns || sample.time_ns > 14 * test::kSweep_ns) continue;
    ahead.push_back(sample);
    AngularRateState& rate = rates.emplace_back();
    rate.time_ns = sample.time_ns;
    rate.w_WI_I_rad_s = sample.angular_velocity_rad_s;
  }
  ASSERT_EQ(ahead.size(), 20u);
  ASSERT_TRUE(run.odometry.predict(ahead, rates, pose).ok());
  EXPECT_EQ(pose.time_ns, 14 * test::kSweep_ns);
  EXPECT_LT(run.error_m(pose), 0.05);
  EXPECT_GT(pose.covariance.diagonal().head<3>().sum(), run.report.pose.covariance.diagonal().head<3>().sum());
  // an odometer reading is fused with its stated uncertainty
  Odometry told(run.odometry);
  const Eigen::Vector3d v_I_m_s(3.0, 0.0, 0.0);
  ASSERT_TRUE(told.set_odometer_reading(VelocityReading{12 * test::kSweep_ns, v_I_m_s, 0.001}).ok());
  PoseState led;
  ASSERT_TRUE(told.predict(ahead, rates, led).ok());
  EXPECT_GT((led.position_W_m - pose.position_W_m).norm(), 0.1);
  // a repeated reading is rejected, and the odometry ignores the whole list
  std::swap(ahead[0], ahead[1]);
  std::swap(rates[0], rates[1]);
  EXPECT_EQ(run.odometry.predict(ahead, rates, pose).error_code, ErrorCode::time_order);
  run.sweeps(12, 13);
  Drive other(given());
  other.sweeps(0, 13);
  EXPECT_EQ(run.report.pose.position_W_m, other.report.pose.position_W_m);
}

TEST(Window, PosesCanBeAskedAtAnyTimeWithin) {
  Odometry::Params params = given();
  params.expert.window_sweeps = 3;
  Drive run(params);
  PoseState pose;
  EXPECT_EQ(run.odometry.pose_at(0, pose).error_code, ErrorCode::empty);
  run.sweeps(0, 12);
  EXPECT_EQ(run.odometry.pose_at(9 * test::kSweep_ns - 1, pose).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(run.odometry.pose_at(12 * test::kSweep_ns + 1, pose).error_code, ErrorCode::out_of_range);
  const auto open = run.odometry.window_trajectories();
  for (const auto& sweep : open) {
    ASSERT_TRUE(run.odometry.pose_at(sweep[4].time_ns, pose).ok());
    EXPECT_LT((pose.position_W_m - sweep[4].position_W_m).norm(), 1e-9);
    EXPECT_LT((pose.covariance - sweep[4].covariance).norm(), 1e-9);
  }
  for (TimeNs t = 9 * test::kSweep_ns + 3'456'789; t < 12 * test::kSweep_ns; t += 7'654'321) {
    ASSERT_TRUE(run.odometry.pose_at(t, pose).ok());
    EXPECT_EQ(pose.time_ns, t);
    // also between IMU samples; at 15 rad/s and metres per second. Measured: 12 mm
    EXPECT_LT(run.error_m(pose), 0.03);
    EXPECT_LT(so3::logarithm(pose.orientation_W * run.motion.q(1e-9 * static_cast<double>(t)).conjugate()).norm(),
              0.02);
    EXPECT_GT(pose.covariance.diagonal().minCoeff(), 0.0);
  }
}

void run_on_threads(std::size_t threads, std::size_t count, const std::function<void(std::size_t)>& body) {
  std::vector<std::thread> workers;
  for (std::size_t t = 0; t < threads; ++t) {
    workers.emplace_back([&, t] {
      for (std::size_t i = t; i < count; i += threads) body(i);
    });
  }
  for (std::thread& worker : workers) worker.join();
}

TEST(ExecutorThreads, BitsDoNotDependOnTheThreadsThatTheCallerGives) {
  Drive alone(given());
  alone.sweeps(0, 8);
  const std::vector<MapPoint> expected = alone.odometry.map();
  for (const std::size_t threads : {1u, 2u, 3u, 7u}) {
    Odometry::Params params = given();
    std::size_t calls = 0;
    params.parallel_for = [&](std::size_t count, const std::function<void(std::size_t)>& body) {
      ++calls;
      run_on_threads(threads, count, body);
    };
    Drive run(params);
    run.sweeps(0, 8);
    EXPECT_GT(calls, 20u);  // the callback was called
    EXPECT_EQ(run.report.pose.position_W_m, alone.report.pose.position_W_m);
    EXPECT_EQ(run.report.pose.orientation_W.coeffs(), alone.report.pose.orientation_W.coeffs());
    EXPECT_EQ(run.report.pose.covariance, alone.report.pose.covariance);
    const std::vector<MapPoint> map = run.odometry.map();
    ASSERT_EQ(map.size(), expected.size());
    for (std::size_t i = 0; i < map.size(); ++i) ASSERT_EQ(map[i].position_W_m, expected[i].position_W_m);
  }
}

TEST(ExecutorThreads, OrderDoesNotMatterEither) {
  Drive alone(given());
  alone.sweeps(0, 8);
  Odometry::Params params = given();
  params.parallel_for = [](std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  Drive run(params);
  run.sweeps(0, 8);
  EXPECT_EQ(run.report.pose.position_W_m, alone.report.pose.position_W_m);
}

}  // namespace
}  // namespace tumble
