// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/registration.hpp"

#include "tests/estimator/mapping/room_map.hpp"
#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using test::loose_prior;
using test::map_of;

/// Returns samples of a stationary IMU over 0.1 s at the origin.
std::vector<MotionSample> still_samples() {
  MotionSample sample;
  sample.time_ns = test::kSweep_ns;
  sample.f_I_m_s2 = Eigen::Vector3d(0, 0, test::kRoomGravity_m_s2);
  return {sample};
}

std::vector<SweepPoint> still_points(const test::Room& room, double noise_m = 0.0) {
  test::Motion still;
  still.rest_s = 1e9;
  // tilted, so that the rings of the sweep differ from those of the map
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();
  T_IL.linear() = so3::exp({0.5, -0.4, 0.3}).toRotationMatrix();
  std::vector<SweepPoint> points;
  select_points(test::make_sweep(room, still, T_IL, 40, noise_m), {0.3, 30.0, Eigen::AlignedBox3d()}, T_IL, 0.0,
                points);
  std::vector<SweepPoint> chosen;
  for (std::size_t i = 0; i < points.size(); i += 5) chosen.push_back(points[i]);
  return chosen;
}

Registration::Result align(const test::Room& room, const Registration::Prior& prior, Registration::Params params = {},
                           double noise_m = 0.0) {
  Registration registration(params);
  SweepTrajectory trajectory;
  Registration::Result result;
  const VoxelMap map = map_of(room, noise_m);
  const std::vector<SweepPoint> points = still_points(room, noise_m);
  EXPECT_GT(points.size(), 1000u);
  EXPECT_TRUE(registration.align(prior, still_samples(), test::kSweep_ns, points, map, trajectory, result).ok());
  return result;
}

TEST(Registration, DerivativesMatchDifferences) {
  const test::Motion motion;
  std::vector<MotionSample> samples = test::motion_samples(test::make_imu(motion, 1.2));
  for (std::size_t i = 104; i < 109; ++i) samples[i].clipped_axes = 5;  // x and z, in a part of the sweep
  MotionState start;
  start.time_ns = 1'000'000'000;
  start.q_WI = so3::exp({0.3, -0.2, 0.9});
  start.v_WI_m_s = Eigen::Vector3d(2, -1, 0.5);
  RegistrationUnknowns::Deficit deficit;
  deficit << 0.4, 0.9, -0.3, 0.0, 0.0, 0.0, -0.2, 0.1, 0.5;
  SweepPoint measured;
  measured.point_L_m = Eigen::Vector3f(7.0f, -3.0f, 2.0f);
  measured.t_s = 0.073f;
  LidarImuCalibration nominal;
  nominal.T_IL.linear() = so3::exp({0.2, -0.1, -1.4}).toRotationMatrix();
  nominal.T_IL.translation() = Eigen::Vector3d(0.02, 0.09, 0.04);
  PlaneFit plane;
  plane.normal_W = Eigen::Vector3f(0.5f, -0.3f, 0.8f).normalized();

  const auto residual = [&](const Registration::Vector& d, Registration::Vector& derivative) {
    MotionState moved = start;
    moved.p_WI_m += d.segment<3>(0);
    moved.q_WI = so3::exp(d.segment<3>(3)) * moved.q_WI;
    moved.v_WI_m_s += d.segment<3>(6);
    LidarImuCalibration calibration = nominal;
    calibration.add(d.tail<LidarImuCalibration::kErrorCount>());
    // in doubles, because the floats of a SweepPoint would hide steps this small
    const Eigen::Vector3d x_I = calibration.T_IL * measured.point_L_m.cast<double>();
    SweepTrajectory trajectory;
    const RegistrationUnknowns::Deficit moved_deficit =
        deficit + d.segment<9>(Registration::kFirstDeficitUnknown).reshaped(3, SweepTrajectory::kKnots);
    EXPECT_TRUE(trajectory.build(moved, samples, 1'100'000'000, calibration.gravity_W_m_s2, moved_deficit).ok());
    std::size_t hint = 0;
    const double t = static_cast<double>(measured.t_s) + calibration.imu_minus_lidar_clock_s;
    const SweepTrajectory::PreintegratedMotion now = trajectory.at(t, hint);
    SweepPoint point = measured;
    point.x_I_m = x_I.cast<float>();
    Registration::residual(trajectory, calibration, point, plane, hint, derivative);
    return plane.normal_W.cast<double>().dot(trajectory.gravity_free_position_m(t) + now.preintegrated_position_m +
                                             now.q_WI * x_I);
  };
  Registration::Vector analytic, unused;
  residual(Registration::Vector::Zero(), analytic);
  const double h = 1e-5;
  for (int i = 0; i < Registration::kUnknowns; ++i) {
    Registration::Vector step = Registration::Vector::Zero();
    step[i] = h;
    const double numeric = (residual(step, unused) - residual(-step, unused)) / (2.0 * h);
    // floats of the point and the plane over the lever: 1e-6 of it. Deficit: its effect within a sample is of first
    // order, 1 %
    const bool of_deficit = i >= Registration::kFirstDeficitUnknown && i < Registration::kFirstCalibrationUnknown;
    const double tolerance = (of_deficit ? 0.01 : 1e-5) * std::abs(numeric) + 1e-5;
    EXPECT_NEAR(analytic[i], numeric, tolerance) << "unknown " << i;
    // negative control: the same comparison rejects a derivative that is wrong by a twentieth
    if (std::abs(numeric) > 1e-3) {
      EXPECT_GT(std::abs(1.05 * analytic[i] - numeric), tolerance) << "unknown " << i;
    }
  }
  EXPECT_EQ(analytic[10], 0.0);            // axis y was not clipped
  EXPECT_GT(std::abs(analytic[9]), 1e-3);  // axis x was clipped
}

TEST(Registration, FindsAKnownPoseInARoom) {
  Registration::Prior prior = loose_prior(1.0, 0.3);
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.25, -0.2, 0.1);
  prior.mean.state.q_WI = so3::exp({0.03, -0.02, 0.05});
  const Registration::Result result = align(test::Room::box_with_pillars(), prior);
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  // surfaces without noise; planes on pillars are curved within a neighbourhood; measured 0.6 mm, 5e-5 rad
  EXPECT_LT(result.mean.state.p_WI_m.norm(), 0.004);
  EXPECT_LT(so3::logarithm(result.mean.state.q_WI).norm(), 5e-4);
  EXPECT_GT(static_cast<double>(result.inliers) / static_cast<double>(result.points), 0.8);
  EXPECT_GT(result.eigenvalues[0] / result.eigenvalues[5], 0.02);
}

TEST(Registration, NamesTheFreeDirectionsOfAFloor) {
  Registration::Prior prior = loose_prior(0.1, 0.05);
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.08, -0.06, 0.15);
  prior.mean.state.q_WI = so3::exp({0.02, -0.015, 0.03});
  const Registration::Result result = align(test::Room::floor_only(), prior);
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  // height, roll and pitch are found, and the prior's x, y and yaw remain
  EXPECT_NEAR(result.mean.state.p_WI_m.z(), 0.0, 0.005);
  EXPECT_NEAR(result.mean.state.p_WI_m.x(), 0.08, 0.01);
  EXPECT_NEAR(result.mean.state.p_WI_m.y(), -0.06, 0.01);
  const Eigen::Vector3d turned = so3::logarithm(result.mean.state.q_WI);
  EXPECT_NEAR(turned.x(), 0.0, 1e-3);
  EXPECT_NEAR(turned.y(), 0.0, 1e-3);
  EXPECT_NEAR(turned.z(), 0.03, 2e-3);
  // the three smallest eigenvalues vanish, the fourth does not, and their directions are x, y and yaw
  EXPECT_LT(result.eigenvalues[2], 1e-4);
  EXPECT_GT(result.eigenvalues[3], 1e-2);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix<double, 6, 1> d = result.directions.col(i);
    EXPECT_NEAR(std::hypot(d[0], d[1], d[5]), 1.0, 1e-2) << "direction " << i;
  }
  // undetermined directions stay as uncertain as the prior
  EXPECT_NEAR(std::sqrt(result.covariance(0, 0)), 0.1, 0.02);
  EXPECT_LT(std::sqrt(result.covariance(2, 2)), 0.01);
}

TEST(Registration, BeginsElsewhereAndKeepsItsPrior) {
  Registration::Prior prior = loose_prior(0.3, 0.1);
  prior.start = prior.mean.state;
  prior.start->p_WI_m = Eigen::Vector3d(0.5, 0.4, 0.2);
  const Registration::Result room = align(test::Room::box_with_pillars(), prior);
  ASSERT_EQ(room.verdict, RegistrationVerdict::converged);
  EXPECT_LT(room.mean.state.p_WI_m.norm(), 0.02);
  // nothing constrains the sensor along a floor: the mean decides, not the start (0.64 m away)
  const Registration::Result floor = align(test::Room::floor_only(), prior);
  ASSERT_EQ(floor.verdict, RegistrationVerdict::converged);
  EXPECT_LT(floor.mean.state.p_WI_m.norm(), 0.05);
}

TEST(Registration, NamesTheAxisOfACorridor) {
  Registration::Prior prior = loose_prior(0.1, 0.05);
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.1, 0.08, -0.05);
  const Registration::Result result = align(test::Room::corridor(), prior);
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  // the prior constrains the free direction, except for wrong normals at the edges of floor and walls; measured 0.075
  EXPECT_NEAR(result.mean.state.p_WI_m.x(), 0.1, 0.04);
  EXPECT_NEAR(result.mean.state.p_WI_m.y(), 0.0, 0.005);
  EXPECT_NEAR(result.mean.state.p_WI_m.z(), 0.0, 0.005);
  EXPECT_LT(result.eigenvalues[0], 1e-3);
  EXPECT_GT(result.eigenvalues[1], 5e-3);
  EXPECT_NEAR(std::abs(result.directions(0, 0)), 1.0, 1e-2);
}

/// Noisy ranges tilt the normals of floor and walls, as if there were surfaces across the corridor.
TEST(Registration, TakesNoNoiseOfNormalsForInformation) {
  constexpr double kNoise_m = 0.02;  // range noise of the RS-16
  const Registration::Prior prior = loose_prior(0.5, 0.05);
  const Registration::Result corridor = align(test::Room::corridor(), prior, {}, kNoise_m);
  ASSERT_EQ(corridor.verdict, RegistrationVerdict::converged);
  EXPECT_NEAR(std::abs(corridor.directions(0, 0)), 1.0, 1e-2);
  // information along the axis in the covariance, in addition to the prior's: 943 of 920; if accepted it would claim
  // 3.3 cm
  const double along = 1.0 / corridor.covariance(0, 0) - 1.0 / (0.5 * 0.5);
  EXPECT_GT(along, 500.0);
  EXPECT_NEAR(corridor.surface_normal_noise_information(0, 0) / along, 1.0, 0.2);
  EXPECT_GT(corridor.least_constrained_sigma_m, 0.1);
  const Registration::Result corner = align(test::Room::corner(), prior, {}, kNoise_m);
  ASSERT_EQ(corner.verdict, RegistrationVerdict::converged);
  // and where surfaces constrain all six directions, nearly none: 610 of 33 800
  EXPECT_LT(corner.surface_normal_noise_information(0, 0) * corner.covariance(0, 0), 0.05);
  EXPECT_LT(corner.least_constrained_sigma_m, 0.05);
}

/// The surfaces observe only the lidar's pose: neither they nor the noise of their normals observe an IMU that is
/// rotated together with the inverse mounting. If the noise covered only the motion (control), the error of such a
/// rotation would grow with each sweep.
TEST(Registration, TakesNoNoiseOfNormalsForInformationOfAMounting) {
  constexpr double kNoise_m = 0.02;
  Registration::Prior prior = loose_prior(0.5, 0.05);
  prior.covariance.bottomRightCorner<LidarImuCalibration::kErrorCount, LidarImuCalibration::kErrorCount>()
      .topLeftCorner<6, 6>()
      .setIdentity();
  prior.covariance.bottomRightCorner<LidarImuCalibration::kErrorCount, LidarImuCalibration::kErrorCount>() *=
      0.01 * 0.01;
  const Registration::Result corridor = align(test::Room::corridor(), prior, {}, kNoise_m);
  ASSERT_EQ(corridor.verdict, RegistrationVerdict::converged);
  const Registration::Matrix& B = corridor.surface_normal_noise_information;
  const Eigen::Matrix3d R = corridor.mean.state.q_WI.toRotationMatrix();
  const Eigen::Vector3d lever_m = corridor.mean.calibration.T_IL.translation();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turned = Eigen::Vector3d::Unit(axis);
    Registration::Vector unseen = Registration::Vector::Zero();
    unseen.segment<3>(0) = R * turned.cross(lever_m);
    unseen.segment<3>(3) = -(R * turned);
    const double of_motion = unseen.dot(B * unseen);
    unseen.segment<3>(Registration::kFirstCalibrationUnknown) = turned;
    EXPECT_GT(of_motion, 100.0) << axis;
    // the attitude in a sweep at rest varies in the last digits
    EXPECT_LT(std::abs(unseen.dot(B * unseen)), 1e-3 * of_motion) << axis;
  }
}

TEST(Registration, FindsAllSixInACorner) {
  Registration::Prior prior = loose_prior(0.5, 0.2);
  prior.mean.state.p_WI_m = Eigen::Vector3d(-0.1, 0.12, 0.08);
  prior.mean.state.q_WI = so3::exp({-0.02, 0.02, 0.03});
  const Registration::Result result = align(test::Room::corner(), prior);
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  EXPECT_LT(result.mean.state.p_WI_m.norm(), 0.004);
  EXPECT_LT(so3::logarithm(result.mean.state.q_WI).norm(), 5e-4);
}

TEST(Registration, NeverTakesNoMatchesForSuccess) {
  Registration registration(Registration::Params{});
  SweepTrajectory trajectory;
  Registration::Result result;
  const std::vector<SweepPoint> points = still_points(test::Room::box());
  const Registration::Prior prior = loose_prior(0.3, 0.1);
  // an empty map, then a map out of reach
  VoxelMap map({0.5, 0.1});
  ASSERT_TRUE(registration.align(prior, still_samples(), test::kSweep_ns, points, map, trajectory, result).ok());
  EXPECT_EQ(result.verdict, RegistrationVerdict::too_few_matches);
  EXPECT_EQ(result.matches, 0u);
  EXPECT_EQ(result.mean.state.p_WI_m, prior.mean.state.p_WI_m);
  for (int i = 0; i < 1000; ++i) {
    const int column = i % 30, row = i / 30;
    map.insert({500.0f + 0.1f * column, 0.1f * row, 0.0f}, 0.02f, 0);
  }
  ASSERT_TRUE(registration.align(prior, still_samples(), test::kSweep_ns, points, map, trajectory, result).ok());
  EXPECT_EQ(result.verdict, RegistrationVerdict::too_few_matches);
  ASSERT_TRUE(registration.align(prior, still_samples(), test::kSweep_ns, {}, map, trajectory, result).ok());
  EXPECT_EQ(result.verdict, RegistrationVerdict::too_few_matches);
}

/// Tests a sweep that overlaps little with the map: some sixty points.
Registration::Result align_few(const Registration::Prior& prior, std::size_t agreeing_matches_needed) {
  const test::Room room = test::Room::box_with_pillars();
  std::vector<SweepPoint> points;
  for (const SweepPoint& point : still_points(room)) {
    if (points.size() < 60 && point.ring % 4 == 0) points.push_back(point);
  }
  Registration::Params params;
  params.expert.agreeing_matches_needed = agreeing_matches_needed;
  params.expert.correlation_discount = 1.0;  // the room has no noise to share
  Registration registration(params);
  SweepTrajectory trajectory;
  Registration::Result result;
  EXPECT_TRUE(
      registration.align(prior, still_samples(), test::kSweep_ns, points, map_of(room), trajectory, result).ok());
  EXPECT_LT(result.matches, params.expert.matches_min);
  return result;
}

TEST(Registration, AcceptsFewMatchesWhereThePriorExpectsThem) {
  Registration::Prior prior = loose_prior(0.1, 0.03);
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.08, -0.06, 0.04);
  const Registration::Result result = align_few(prior, 30);
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  EXPECT_LT(result.mean.state.p_WI_m.norm(), 0.3 * prior.mean.state.p_WI_m.norm());
  // fewer than enough with the default number
  EXPECT_EQ(align_few(prior, 1000).verdict, RegistrationVerdict::too_few_matches);
  EXPECT_EQ(align_few(prior, Registration::Params{}.expert.agreeing_matches_needed).verdict,
            RegistrationVerdict::too_few_matches);
}

TEST(Registration, RejectsFewMatchesWhereThePriorExpectsMore) {
  Registration::Prior prior = loose_prior(0.05, 0.03);  // with an error of seven standard deviations
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.25, -0.2, 0.15);
  const Registration::Result result = align_few(prior, 30);
  EXPECT_EQ(result.verdict, RegistrationVerdict::too_few_matches);
  EXPECT_EQ(result.mean.state.p_WI_m, prior.mean.state.p_WI_m);
}

TEST(Registration, RefusesACorrectionBeyondItsBound) {
  Registration::Prior prior = loose_prior(1.0, 0.3);
  prior.mean.state.p_WI_m = Eigen::Vector3d(0.25, -0.2, 0.1);
  Registration::Params params;
  params.expert.correction_max_m = 0.1;
  const Registration::Result result = align(test::Room::box_with_pillars(), prior, params);
  EXPECT_EQ(result.verdict, RegistrationVerdict::diverged);
  EXPECT_EQ(result.mean.state.p_WI_m, prior.mean.state.p_WI_m);
  EXPECT_GT(result.correction_m, 0.1);
}

TEST(Registration, ThrowsOnBadParams) {
  Registration::Params params;
  params.neighbours = 2;
  EXPECT_THROW(Registration{params}, InvalidParams);
  params = {};
  params.match_distance_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Registration{params}, InvalidParams);
}

}  // namespace
}  // namespace tumble
