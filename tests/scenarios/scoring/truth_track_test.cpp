// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/truth_track.hpp"

#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/nearness.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

TEST(TruthTrack, InterpolatesBetweenPhysicsSamples) {
  const testing::SyntheticMotion motion;
  const sim::Recording recording = testing::synthetic_rig(motion);
  const TruthTrack track(recording.truth, Frame::imu);
  const Isometry3d T_BI = recording.truth.imus.front().T_BI;
  for (const std::int64_t time_ns : {0L, 1700000123L, 3000000000L, 3000249999L, 4444444444L, 6000000000L}) {
    ASSERT_TRUE(track.covers(time_ns));
    const double t = 1e-9 * static_cast<double>(time_ns);
    const Vector3d p = motion.position_m(t) + motion.attitude(t) * T_BI.translation();
    const PoseState pose = track.pose(time_ns);
    // linear interpolation between samples errs by acceleration dt^2 / 8 = 21 m/s^2 x 3.1e-8 s^2
    EXPECT_NEAR((pose.position_W_m - p).norm(), 0.0, 1e-6);
    EXPECT_NEAR(rotation_angle_rad((motion.attitude(t) * Quaterniond(T_BI.linear())).conjugate() * pose.orientation_W),
                0.0, 1e-6);
    // the velocity errs by jerk dt^2 / 8 of the IMU on its lever arm of 0.1 m: 14^3 x 0.1 x 3.1e-8
    const Vector3d v = motion.velocity_m_s(t) + motion.attitude(t) * motion.rate_B_rad_s(t).cross(T_BI.translation());
    EXPECT_NEAR((pose.velocity_W_m_s - v).norm(), 0.0, 2e-5);
  }
  EXPECT_FALSE(track.covers(-1));
  EXPECT_FALSE(track.covers(6000000001));
}

TEST(TruthTrack, PathOfTheBodyIsTheLengthOfItsStraightPath) {
  const testing::SyntheticMotion motion;
  const sim::Recording recording = testing::synthetic_rig(motion);
  EXPECT_NEAR(TruthTrack(recording.truth, Frame::body).path_m(6000000000), motion.displacement_m.norm(), 1e-9);
  // a point away from the axis has a longer path
  EXPECT_GT(TruthTrack(recording.truth, Frame::imu).path_m(6000000000), motion.displacement_m.norm() + 0.1);
}

TEST(TruthTrack, RestIsWhereNothingMovesAround) {
  const sim::Recording recording = testing::synthetic_rig();
  const TruthTrack track(recording.truth, Frame::body);
  EXPECT_TRUE(track.at_rest(0));
  EXPECT_TRUE(track.at_rest(1300000000));
  EXPECT_FALSE(track.at_rest(1700000000));
  EXPECT_FALSE(track.at_rest(3000000000));
  EXPECT_TRUE(track.at_rest(5000000000));
  EXPECT_TRUE(track.at_rest(6000000000));
}

TEST(TruthTrack, DoesNotCoverWhatAReferenceDidNotSee) {
  sim::Recording recording = testing::synthetic_rig();
  sim::Truth& truth = recording.truth;
  const TruthTrack whole(recording.truth, Frame::body);
  const std::int64_t period_ns = truth.period_ns;
  const PoseState before = whole.pose(3999 * period_ns);
  const double path_m = whole.path_m(whole.last_ns());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  truth.q_WB[4000].coeffs().setConstant(nan);
  truth.p_WB_m[4000].setConstant(nan);
  truth.v_WB_m_s[4000].setConstant(nan);
  const TruthTrack track(truth, Frame::body);
  EXPECT_FALSE(track.covers(4000 * period_ns));
  EXPECT_FALSE(track.covers(3999 * period_ns + 1));
  EXPECT_FALSE(track.covers(4000 * period_ns + 1));
  ASSERT_TRUE(track.covers(3999 * period_ns));
  EXPECT_TRUE(track.covers(4001 * period_ns));
  EXPECT_EQ(track.pose(3999 * period_ns).position_W_m, before.position_W_m)
      << "the unknown neighbour has no part in it";
  EXPECT_EQ(track.pose(3999 * period_ns).orientation_W.coeffs(), before.orientation_W.coeffs());
  // the path lacks two steps of at most 1 m/s
  EXPECT_NEAR(track.path_m(track.last_ns()), path_m, 1e-3);
}

TEST(TruthTrack, RefusesTruthThatDoesNotFit) {
  sim::Recording recording = testing::synthetic_rig();
  recording.truth.q_WB.pop_back();
  EXPECT_THROW(TruthTrack(recording.truth, Frame::body), BadInput);
  EXPECT_THROW(TruthTrack(sim::Truth{}, Frame::body), BadInput);
  sim::Truth blind = testing::synthetic_sphere().truth;
  blind.lidars.clear();
  EXPECT_THROW(TruthTrack(blind, Frame::lidar), BadInput);
}

TEST(Alignment, RemovesYawAndPositionAndLeavesTilt) {
  PoseState truth;
  truth.position_W_m = {1, 2, 3};
  truth.orientation_W = Eigen::AngleAxisd(0.8, Vector3d(1, -1, 0.5).normalized());
  for (const double yaw : {-3.0, -0.1, 0.0, 1.0, 3.1}) {
    for (const double tilt : {0.0, 0.02}) {
      PoseState estimate;
      estimate.position_W_m = {-5, 0, 0};
      estimate.orientation_W = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) * truth.orientation_W;
      const PoseState aligned = Alignment::at(estimate, truth).apply(estimate);
      EXPECT_NEAR((aligned.position_W_m - truth.position_W_m).norm(), 0.0, 1e-14);
      EXPECT_NEAR(rotation_angle_rad(aligned.orientation_W * truth.orientation_W.conjugate()), tilt, 1e-12);
      EXPECT_NEAR(twist_about_z_rad(aligned.orientation_W * truth.orientation_W.conjugate()), 0.0, 1e-12);
    }
  }
}

TEST(RotationAngle, IsExactForSmallAndLargeAngles) {
  for (const double angle : {0.0, 1e-9, 0.3, 1.6, 3.0, std::numbers::pi}) {
    const Quaterniond q(Eigen::AngleAxisd(angle, Vector3d(2, -1, 1).normalized()));
    EXPECT_NEAR(rotation_angle_rad(q), angle, 1e-15 + 1e-15 * angle);
    EXPECT_NEAR(rotation_angle_rad(Quaterniond(-q.w(), -q.x(), -q.y(), -q.z())), angle, 1e-15 + 1e-15 * angle);
  }
}

TEST(ClippingTruth, NamesTheSaturatedAxes) {
  sim::Recording recording = testing::synthetic_rig();
  const sim::ImuRecord& imu = recording.sensors.imus.front();
  const ClippingTruth truth(recording.sensors, recording.truth);
  std::size_t clipped = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      const bool beyond = std::abs(recording.truth.imus.front().rate_rad_s[k][j]) > 10.5 + 1e-4 / std::sqrt(0.005);
      EXPECT_EQ((truth.clipped_axes(k) >> j) & 1, beyond ? 1 : 0) << k << " " << j;
      clipped += beyond ? 1 : 0;
    }
  }
  EXPECT_GT(clipped, 50u);
  // the truth is the stored one at a stamp, interpolated between two stamps, and absent outside
  EXPECT_EQ(truth.at(imu.time_ns[500])->rate_rad_s, recording.truth.imus.front().rate_rad_s[500]);
  const Vector3d middle =
      0.5 * (recording.truth.imus.front().rate_rad_s[499] + recording.truth.imus.front().rate_rad_s[500]);
  EXPECT_NEAR((truth.at((imu.time_ns[499] + imu.time_ns[500]) / 2)->rate_rad_s - middle).norm(), 0.0, 1e-12);
  EXPECT_FALSE(truth.at(imu.time_ns.front() - 1).has_value());
  EXPECT_FALSE(truth.at(imu.time_ns.back() + 1).has_value());
}

TEST(ClippingTruth, DifferencesBelowTheNoiseAreNoClipping) {
  sim::Recording recording = testing::synthetic_sphere();
  const double sigma = 1e-4 / std::sqrt(0.005);
  recording.truth.imus.front().gyro_unclipped_rad_s[10].x() += 0.9 * sigma;
  recording.truth.imus.front().gyro_unclipped_rad_s[11].y() += 1.1 * sigma;
  const ClippingTruth truth(recording.sensors, recording.truth);
  EXPECT_EQ(truth.clipped_axes(10), 0);
  EXPECT_EQ(truth.clipped_axes(11), 2);
}

// One element is saturated; the compensation of the device spreads its error over the other two axes.
TEST(ClippingTruth, CrossAxisErrorsAreNoClipping) {
  sim::Recording recording = testing::synthetic_sphere();
  sim::ImuTruth& imu = recording.truth.imus.front();
  Matrix3d elements = Eigen::Matrix3d::Identity();
  elements(0, 1) = 0.03;
  elements(2, 1) = -0.02;
  for (int i = 0; i < 3; ++i) imu.gyro_elements.emplace_back(elements.row(i));
  const auto lose = [&](std::size_t k, const Vector3d& deficit_rad_s) {
    recording.sensors.imus.front().gyro_rad_s[k] = imu.gyro_unclipped_rad_s[k] - elements.inverse() * deficit_rad_s;
  };
  lose(10, {0.0, 4.0, 0.0});
  lose(11, {0.0, 4.0, -1.0});
  const ClippingTruth truth(recording.sensors, recording.truth);
  EXPECT_EQ(truth.clipped_axes(10), 0b010);
  EXPECT_EQ(truth.cross_axes(10), 0b101);
  EXPECT_EQ(truth.clipped_axes(11), 0b110);
  EXPECT_EQ(truth.cross_axes(11), 0b001);
  EXPECT_EQ(truth.clipped_axes(12), 0);
  EXPECT_EQ(truth.cross_axes(12), 0);
  const auto sample = truth.at(recording.sensors.imus.front().time_ns[10]);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->clipped_axes, 0b010);
  EXPECT_EQ(sample->cross_axes, 0b101);
}

TEST(Nearness, AgreesWithBruteForce) {
  // the points form a lattice with irrational steps, so that no distance equals the limit
  std::vector<Vector3f> points;
  for (int k = 0; k < 400; ++k) {
    const auto f = [k](float step) { return std::fmod(static_cast<float>(k) * step, 4.0f) - 2.0f; };
    points.emplace_back(f(0.7548777f), f(0.5698403f), f(1.3247179f));
  }
  points.emplace_back(std::nanf(""), 0.0f, 0.0f);
  const float distance = 0.3f;
  const Nearness near(points, distance);
  int yes = 0;
  int no = 0;
  for (int k = 0; k < 1000; ++k) {
    const auto f = [k](float step) { return std::fmod(static_cast<float>(k) * step, 5.0f) - 2.5f; };
    const Vector3f query(f(0.61803399f), f(1.4142136f), f(0.7320508f));
    bool brute = false;
    for (const Vector3f& point : points) brute = brute || (point - query).norm() <= distance;
    EXPECT_EQ(near.has_neighbour(query), brute);
    (brute ? yes : no) += 1;
  }
  EXPECT_GT(yes, 50);
  EXPECT_GT(no, 50);
}

TEST(Nearness, OnePerCellKeepsTheFirst) {
  const std::vector<Vector3f> points = {{0.01f, 0, 0}, {0.02f, 0, 0}, {0.15f, 0, 0}, {-0.01f, 0, 0}};
  const auto kept = one_per_cell(points, 0.1f);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0], points[0]);
  EXPECT_EQ(kept[1], points[2]);
  EXPECT_EQ(kept[2], points[3]);
}

TEST(Nearness, OnePerCellOfManyPointsIsThatOfASetOfCells) {
  std::vector<Vector3f> points;
  for (int k = 0; k < 20000; ++k) {
    const auto f = [k](float step) { return std::fmod(static_cast<float>(k) * step, 3.0f) - 1.5f; };
    points.emplace_back(f(0.7548777f), f(0.5698403f), f(1.3247179f));
    if (k % 3 == 0) points.push_back(points.back() + Eigen::Vector3f::Constant(0.001f));
    if (k % 1000 == 0) points.emplace_back(0.0f, std::nanf(""), 0.0f);
  }
  std::set<std::array<int, 3>> taken;
  std::vector<Vector3f> expected;
  for (const Vector3f& point : points) {
    if (!point.allFinite()) continue;
    const auto cell = [&](int axis) {
      return static_cast<int>(std::floor(static_cast<double>(point[axis]) / static_cast<double>(0.1f)));
    };
    if (taken.insert({cell(0), cell(1), cell(2)}).second) expected.push_back(point);
  }
  EXPECT_GT(expected.size(), 1000u);
  EXPECT_EQ(one_per_cell(points, 0.1f), expected);
}

}  // namespace
}  // namespace tumble::scenarios
