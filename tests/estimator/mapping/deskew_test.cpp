// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/deskew.hpp"

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

Eigen::Isometry3d mounting() {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();
  T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  return T_IL;
}

MotionState true_state(const test::Motion& motion, std::int64_t time_ns) {
  MotionState state;
  state.time_ns = time_ns;
  const double t = 1e-9 * static_cast<double>(time_ns);
  state.p_WI_m = motion.p_m(t);
  state.q_WI = motion.q(t);
  state.v_WI_m_s = motion.v_m_s(t);
  return state;
}

TEST(SweepTrajectory, FollowsTheTrueMotionAtAnyInstant) {
  const test::Motion motion;
  const std::vector<MotionSample> samples = test::motion_samples(test::make_imu(motion, 1.3, 1000.0));
  SweepTrajectory trajectory;
  // neither end coincides with a sample
  const MotionState start = true_state(motion, 1'000'300'000);
  ASSERT_TRUE(trajectory.build(start, samples, 1'200'700'000, test::kRoomGravity_m_s2).ok());
  for (int i = 0; i <= 50; ++i) {
    const double t = trajectory.duration_s() * i / 50.0;
    const MotionState state = trajectory.state(t);
    const double at = 1.0003 + t;
    // 200 ms at 15 rad/s and 1 kHz. The rate rotates within a sample; measured 1e-5 rad, 2e-5 m, 2e-4 m/s
    EXPECT_LT(so3::logarithm(state.q_WI * motion.q(at).conjugate()).norm(), 5e-5) << "t " << t;
    EXPECT_LT((state.p_WI_m - motion.p_m(at)).norm(), 1e-4) << "t " << t;
    EXPECT_LT((state.v_WI_m_s - motion.v_m_s(at)).norm(), 1e-3) << "t " << t;
  }
}

/// Bit for bit: for points in any order, beyond both ends, and at angles beyond the series.
TEST(SweepTrajectory, SaysTheSameOfManyPointsAsOfEach) {
  for (const double spin_rad_s : {15.0, 300.0}) {
    test::Motion motion;
    motion.spin_rad_s = spin_rad_s;
    const std::vector<MotionSample> samples = test::motion_samples(test::make_imu(motion, 1.3, 100.0));
    SweepTrajectory trajectory;
    ASSERT_TRUE(
        trajectory.build(true_state(motion, 1'003'000'000), samples, 1'102'000'000, test::kRoomGravity_m_s2).ok());
    std::vector<SweepPoint> points;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      SweepPoint& point = points.emplace_back();
      const auto share = static_cast<float>(test::uniform(4 * i));
      // in time order first, then in random order
      point.t_s = i < 2000 ? 0.16f * static_cast<float>(i) / 2000.0f - 0.03f : 0.16f * share - 0.03f;
      point.x_I_m = 40.0f * Eigen::Vector3f(static_cast<float>(test::uniform(4 * i + 1)) - 0.5f,
                                            static_cast<float>(test::uniform(4 * i + 2)) - 0.5f,
                                            static_cast<float>(test::uniform(4 * i + 3)) - 0.5f);
    }
    std::vector<Eigen::Vector3f> lever_arm_vectors;
    compute_lever_arm_vectors(trajectory, points, lever_arm_vectors);
    ASSERT_EQ(lever_arm_vectors.size(), points.size());
    std::size_t hint = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const SweepTrajectory::PreintegratedMotion now = trajectory.at(points[i].t_s, hint);
      const Eigen::Vector3d lever = now.preintegrated_position_m + now.q_WI * points[i].x_I_m.cast<double>();
      ASSERT_EQ(lever_arm_vectors[i], lever.cast<float>()) << "spin " << spin_rad_s << ", point " << i;
    }
  }
}

TEST(SweepTrajectory, IsExactForASteadySpinAtRest) {
  // constant rate, and a force that is constant in body axes: a sensor on a circle, with the closed form of the
  // integration
  const Eigen::Vector3d w(3.0, -4.0, 12.0);
  MotionState start;
  std::vector<MotionSample> samples;
  for (int k = 0; k < 10; ++k) {
    MotionSample& s = samples.emplace_back();
    s.from_ns = k * 10'000'000;
    s.time_ns = (k + 1) * 10'000'000;
    s.w_WI_I_rad_s = w;
    s.f_I_m_s2 = Eigen::Vector3d(1.0, 2.0, 3.0);
  }
  SweepTrajectory trajectory;
  ASSERT_TRUE(trajectory.build(start, samples, 100'000'000, 0.0).ok());
  const MotionState end = trajectory.state(0.1);
  EXPECT_LT((end.q_WI.coeffs() - so3::exp(0.1 * w).coeffs()).norm(), 1e-14);
  // v = integral of Exp(w t) f = t J_l(w t) f
  EXPECT_LT((end.v_WI_m_s - 0.1 * so3::left_jacobian(0.1 * w) * samples[0].f_I_m_s2).norm(), 1e-14);
}

// Samples of the next segment do not affect this segment's clipped axes.
TEST(SweepTrajectory, WhatWaitsChangesNothing) {
  MotionSample clipped;
  clipped.from_ns = 0;
  clipped.time_ns = 10'000'000;
  clipped.w_WI_I_rad_s = {10.0, 0.0, 0.0};
  clipped.clipped_axes = 1;
  clipped.rate_sigma_rad_s = {0.5, 0.1, 0.1};
  MotionSample waiting = clipped;
  waiting.from_ns = clipped.time_ns;
  waiting.time_ns = 20'000'000;
  waiting.rate_sigma_rad_s = {50.0, 0.1, 0.1};
  const std::vector<MotionSample> samples = {clipped, waiting};
  SweepTrajectory trajectory;
  ASSERT_TRUE(trajectory.build(MotionState{}, samples, 10'000'000, {0.0, 0.0, -9.8}).ok());
  EXPECT_EQ(trajectory.clipped_axes_at_end().x(), 1.0);
  ASSERT_TRUE(trajectory.build(MotionState{}, samples, 20'000'000, {0.0, 0.0, -9.8}).ok());
  EXPECT_EQ(trajectory.clipped_axes_at_start().x(), 0.01) << "one of the segment does";
}

TEST(SweepTrajectory, SaysWhatItLacks) {
  const std::vector<MotionSample> samples = test::motion_samples(test::make_imu(test::Motion{}, 0.2));
  SweepTrajectory trajectory;
  MotionState start;
  EXPECT_EQ(trajectory.build(start, {}, 100, test::kRoomGravity_m_s2).error_code, ErrorCode::insufficient_data);
  EXPECT_EQ(trajectory.build(start, samples, 200'000'001, test::kRoomGravity_m_s2).error_code,
            ErrorCode::insufficient_data);
  EXPECT_EQ(trajectory.build(start, samples, -1, test::kRoomGravity_m_s2).error_code, ErrorCode::time_order);
  start.time_ns = -1;
  EXPECT_EQ(trajectory.build(start, samples, 100'000'000, test::kRoomGravity_m_s2).error_code, ErrorCode::gap);
  start.time_ns = samples.front().from_ns - 500'000'000;
  const Status gap = trajectory.build(start, samples, 100'000'000, test::kRoomGravity_m_s2);
  EXPECT_EQ(gap.error_code, ErrorCode::gap);
  EXPECT_DOUBLE_EQ(gap.value, 0.5) << "seconds, as of every gap";
  EXPECT_EQ(gap.bound, 0.0);
}

TEST(SweepTrajectory, CovarianceMatchesDifferences) {
  const test::Motion motion;
  const std::vector<MotionSample> samples = test::motion_samples(test::make_imu(motion, 1.2));
  MotionState start = true_state(motion, 1'000'000'000);
  start.covariance.setIdentity();
  SweepTrajectory trajectory;
  ASSERT_TRUE(trajectory.build(start, samples, 1'100'000'000, test::kRoomGravity_m_s2).ok());
  const MotionState nominal = trajectory.state(0.1);
  Eigen::Matrix<double, 9, 9> F;
  const double h = 1e-6;
  for (int i = 0; i < 9; ++i) {
    MotionState moved = start;
    Eigen::Matrix<double, 9, 1> d = Eigen::Matrix<double, 9, 1>::Zero();
    d[i] = h;
    moved.p_WI_m += d.head<3>();
    moved.q_WI = so3::exp(d.segment<3>(3)) * moved.q_WI;
    moved.v_WI_m_s += d.tail<3>();
    ASSERT_TRUE(trajectory.build(moved, samples, 1'100'000'000, test::kRoomGravity_m_s2).ok());
    const MotionState end = trajectory.state(0.1);
    F.col(i) << (end.p_WI_m - nominal.p_WI_m) / h, so3::logarithm(end.q_WI * nominal.q_WI.conjugate()) / h,
        (end.v_WI_m_s - nominal.v_WI_m_s) / h;
  }
  // forward differences of order h; measured 2e-6
  EXPECT_LT((nominal.covariance - F * F.transpose()).cwiseAbs().maxCoeff(), 2e-5);
  EXPECT_GT((nominal.covariance - start.covariance).cwiseAbs().maxCoeff(), 1e-2);  // the covariance must grow
}

class DeskewedSweep : public testing::Test {
 protected:
  /// Returns the largest distance to the room's surfaces of a sweep at 15 rad/s, deskewed to its end with scaled rates.
  double largest_distance(double rate_scale) {
    const test::Motion motion;
    const test::Room room = test::Room::box_with_pillars();
    std::vector<MotionSample> samples = test::motion_samples(test::make_imu(motion, 1.3, 1000.0));
    for (MotionSample& s : samples) s.w_WI_I_rad_s *= rate_scale;
    const std::vector<LidarPoint> points = test::make_sweep(room, motion, mounting(), 11);
    EXPECT_GT(points.size(), 10'000u);
    SweepTrajectory trajectory;
    EXPECT_TRUE(
        trajectory.build(true_state(motion, 1'100'000'000), samples, 1'200'000'000, test::kRoomGravity_m_s2).ok());
    std::vector<SweepPoint> selected;
    const PointCounts counts = select_points(points, {0.0, 100.0, Eigen::AlignedBox3d()}, mounting(), 0.0, selected);
    EXPECT_EQ(counts.usable_points, points.size());
    std::vector<Eigen::Vector3f> at_end;
    deskew(trajectory, selected, trajectory.duration_s(), at_end);
    const MotionState end = trajectory.state(trajectory.duration_s());
    double worst = 0.0;
    for (const Eigen::Vector3f& x : at_end) {
      worst = std::max(worst, room.distance(end.q_WI * x.cast<double>() + end.p_WI_m));
    }
    return worst;
  }
};

TEST_F(DeskewedSweep, LiesOnTheSurfaces) {
  // attitude error within samples at 1 kHz, times a range of 14 m; measured 4e-4 m
  EXPECT_LT(largest_distance(1.0), 2e-3);
}

TEST_F(DeskewedSweep, MissesThemWithAClippedRate) {
  EXPECT_GT(largest_distance(0.7), 1.0);  // error of 0.45 rad over the sweep; measured metres
}

TEST(SelectPoints, DropsWhatIsNoReturnOfTheWorld) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<LidarPoint> points(6);
  points[0].position_L_m = {5, 0, 0};
  points[1].position_L_m = {nan, 0, 0};
  points[2].position_L_m = {0.1f, 0, 0};   // below the minimum range
  points[3].position_L_m = {0.45f, 0, 0};  // return from the robot itself
  points[4].position_L_m = {200, 0, 0};
  points[5].position_L_m = {0, 0, std::numeric_limits<float>::infinity()};
  const Eigen::AlignedBox3d body(Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23));
  std::vector<SweepPoint> selected;
  const PointCounts counts = select_points(points, {0.3, 100.0, body}, mounting(), 0.25, selected);
  EXPECT_EQ(counts.received, 6u);
  EXPECT_EQ(counts.finite, 4u);
  ASSERT_EQ(selected.size(), 1u);
  EXPECT_FLOAT_EQ(selected[0].t_s, 0.25f);
  EXPECT_FLOAT_EQ(selected[0].range_m, 5.0f);
  EXPECT_LT((selected[0].x_I_m - Eigen::Vector3f(0.02f, 0.087f - 5.0f, 0.04f)).norm(), 1e-5f);
}

TEST(SweepSampler, TakesTheFirstPointOfEachCube) {
  SweepSampler sampler;
  std::vector<std::uint32_t> chosen;
  const std::vector<Eigen::Vector3f> points = {{0.1f, 0, 0}, {0.2f, 0, 0}, {0.3f, 0, 0}, {-0.1f, 0, 0}};
  for (int run = 0; run < 2; ++run) {  // the second run must not depend on the first
    sampler.choose_points_per_voxel(points, 0.25, chosen);
    EXPECT_EQ(chosen, (std::vector<std::uint32_t>{0, 2, 3}));
  }
}

}  // namespace
}  // namespace tumble
