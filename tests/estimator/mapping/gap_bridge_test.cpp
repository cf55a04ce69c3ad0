// SPDX-License-Identifier: BSD-3-Clause
// Tests a gap of the IMU data: the interpolated rate and its uncertainty; docs/maths/mapping.md (R44), (R43).
#include "estimator/src/mapping/inertial_track.hpp"

#include "oracles/gaussian.hpp"
#include "tests/estimator/mapping/room_tumble.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::mapping {
namespace {

constexpr TimeNs kMs_ns = 1'000'000;

WindowRate window(const Eigen::Vector3d& rate_rad_s, double sigma_rad_s, TimeNs from_ms, TimeNs to_ms) {
  return {rate_rad_s, Eigen::Vector3d::Constant(sigma_rad_s), from_ms * kMs_ns, to_ms * kMs_ns};
}

std::vector<MotionSample> bridge(const WindowRate& before, const WindowRate& after) {
  std::vector<MotionSample> parts;
  bridge_gap(before, after, parts);
  return parts;
}

TEST(GapBridge, GoesInALineFromReadingToReading) {
  const Eigen::Vector3d from(1.0, -2.0, 3.0), to(5.0, 2.0, -3.0);
  const auto parts = bridge(window(from, 0.1, 95, 100), window(to, 0.3, 255, 260));
  ASSERT_EQ(parts.size(), 16u);
  TimeNs border_ns = 100 * kMs_ns;
  for (const MotionSample& part : parts) {
    EXPECT_EQ(part.from_ns, border_ns);
    border_ns = part.time_ns;
    const double u = (0.5e-9 * static_cast<double>(part.from_ns + part.time_ns) - 0.1) / 0.155;
    EXPECT_LT((part.w_WI_I_rad_s - (1.0 - u) * from - u * to).norm(), 1e-9);
    EXPECT_NEAR(part.rate_sigma_rad_s.y(),
                std::sqrt(std::pow(0.1 * (1.0 - u), 2) + std::pow(0.3 * u, 2) +
                          std::pow(InertialNoiseParams::kGapRateWalk_rad_s_sqrt_s, 2) * u * (1.0 - u) * 0.155),
                1e-9);
    EXPECT_TRUE(part.bridges_gap);
    EXPECT_EQ(part.clipped_axes, 7);
  }
  EXPECT_EQ(border_ns, 255 * kMs_ns);
  // a long gap has no more parts, and no more uncertainty than the upper bound
  const auto many = bridge(window(from, 0.1, 95, 100), window(to, 0.3, 6100, 6105));
  EXPECT_LE(many.size(), 64u);
  EXPECT_EQ(many[many.size() / 2].rate_sigma_rad_s,
            Eigen::Vector3d::Constant(InertialNoiseParams::kRateSigmaMax_rad_s));
  EXPECT_EQ(many.back().time_ns, 6100 * kMs_ns);
}

/// Returns the mean of the squared errors over the stated variance, for rates that walk by `walk` and are read with 0.2
/// rad/s.
double squared_over_stated(double walk) {
  oracles::Gaussian noise(3);
  double sum = 0.0;
  int count = 0;
  for (int run = 0; run < 400; ++run) {
    std::vector<double> truth(201);  // one step per millisecond
    for (std::size_t k = 1; k < truth.size(); ++k) truth[k] = truth[k - 1] + walk * std::sqrt(0.001) * noise();
    const WindowRate before = window({truth.front() + 0.2 * noise(), 0.0, 0.0}, 0.2, -5, 0);
    const WindowRate after = window({truth.back() + 0.2 * noise(), 0.0, 0.0}, 0.2, 200, 205);
    for (const MotionSample& part : bridge(before, after)) {
      const auto middle = static_cast<std::size_t>((part.from_ns + part.time_ns) / 2 / kMs_ns);
      sum += std::pow((part.w_WI_I_rad_s.x() - truth[middle]) / part.rate_sigma_rad_s.x(), 2);
      ++count;
    }
  }
  return sum / count;
}

TEST(GapBridge, StatesWhatARandomWalkIsOffBy) {
  constexpr double kStated = InertialNoiseParams::kGapRateWalk_rad_s_sqrt_s;
  EXPECT_NEAR(squared_over_stated(kStated), 1.0, 0.12);
  // negative controls: twice and half the walk
  EXPECT_GT(squared_over_stated(2.0 * kStated), 2.0);
  EXPECT_LT(squared_over_stated(0.5 * kStated), 0.5);
}

struct Followed {
  double end_m = 0.0, worst_rad = 0.0, worst_nees = 0.0;
};

/// Runs the tumble through a room without the 10 ms samples from `first` to `first` + `missing` - 1. Sweeps wait until
/// the IMU data cover them.
Followed over_a_gap(LidarInertialOdometry::Params params, int first, int missing) {
  params.expert.saturated_imu.estimate_deficit = true;
  LidarInertialOdometry odometry(params);
  const test::RoomTumble& room = test::room_tumble();
  Followed out;
  int next = 0;
  for (int k = 0; k < 20 * test::kSamplesPerSweep; ++k) {
    if (k >= first && k < first + missing) continue;
    const ImuSample& sample = room.imu[static_cast<std::size_t>(k)];
    EXPECT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    for (; (next + 1) * test::kSweep_ns <= sample.time_ns; ++next) {
      LidarInertialOdometry::SweepResult report;
      EXPECT_TRUE(test::add_sweep(odometry, next, room.sweeps[static_cast<std::size_t>(next)], report).ok());
      if ((next + 1) * test::kSamplesPerSweep <= first) continue;
      const double t_s = 1e-9 * static_cast<double>(report.pose.time_ns);
      Eigen::Matrix<double, 6, 1> off;
      off << report.pose.position_W_m - room.motion.p_m(t_s),
          so3::logarithm(report.pose.orientation_W * room.motion.q(t_s).conjugate());
      const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> weight(report.pose.covariance);
      out.end_m = off.head<3>().norm();
      out.worst_rad = std::max(out.worst_rad, off.tail<3>().norm());
      out.worst_nees = std::max(out.worst_nees, off.dot(weight.solve(off)) / 6.0);
    }
  }
  return out;
}

TEST(GapBridge, TheMapperGoesThroughAndSaysHowSurely) {
  for (const int missing : {12, 30}) {
    for (const int first : {83, 121}) {
      const Followed run = over_a_gap(test::rig_params(), first, missing);
      EXPECT_LT(run.end_m, 0.015) << missing << " from " << first;
      EXPECT_LT(run.worst_rad, 0.1) << missing << " from " << first;
      EXPECT_LT(run.worst_nees, 2.0) << missing << " from " << first;
    }
  }
}

}  // namespace
}  // namespace tumble::mapping
