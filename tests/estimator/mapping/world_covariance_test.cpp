// SPDX-License-Identifier: BSD-3-Clause
// Compares the difference between map and world with closed forms: docs/maths/mapping.md, "Reported covariance".
#include "estimator/src/mapping/state_estimate.hpp"

#include "estimator/src/mapping/unknowns.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::mapping {
namespace {

namespace u = unknowns;
using Matrix = Registration::Matrix;
using Pose = WorldCovariance::Pose;

const Eigen::Vector3d kPlace_W_m(10.0, -4.0, 2.0);
const Eigen::Vector3d kLever_m(0.02, -0.1, 0.05);
const Eigen::Quaterniond kStart(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));

WorldCovarianceParams without_tilt() {
  WorldCovarianceParams params;
  params.tilt_sigma_rad = 0.0;
  return params;
}

/// Returns the covariance without the map's scale, which the last test checks.
Pose in_world(const WorldCovariance& covariance, const Matrix& joint = Matrix::Zero()) {
  Pose P = covariance.in_world_frame(joint, kPlace_W_m);
  P.topLeftCorner<3, 3>() -= 0.003 * 0.003 * kPlace_W_m * kPlace_W_m.transpose();
  return P;
}

TEST(WorldCovariance, ATiltOfTheStartTurnsThePathAboutIt) {
  WorldCovarianceParams params;
  params.tilt_sigma_rad = 0.01;
  const Pose P = in_world(WorldCovariance(params, kStart, kLever_m));
  // about x, y and z of the position change; about y, x and z
  const double z = kPlace_W_m.z(), s2 = 1e-4;
  EXPECT_NEAR(P(0, 0), s2 * z * z, 1e-15);
  EXPECT_NEAR(P(1, 1), s2 * z * z, 1e-15);
  EXPECT_NEAR(P(2, 2), s2 * kPlace_W_m.head<2>().squaredNorm(), 1e-15);
  EXPECT_NEAR(P(3, 3), s2, 1e-15);
  EXPECT_EQ(P(5, 5), 0.0);
}

/// An error of the mounting displaces the first pose in the map and all later poses: at the start, and wherever the
/// body has the same attitude, there is no error relative to the world.
TEST(WorldCovariance, AnErrorOfTheMountingIsNoneOfTheStart) {
  const WorldCovariance covariance(without_tilt(), kStart, kLever_m);
  Matrix joint = Matrix::Zero();
  u::sub_block(joint, u::mounting) = Eigen::Matrix<double, 6, 1>(1e-4, 2e-4, 3e-4, 1e-6, 2e-6, 3e-6).asDiagonal();
  const Pose K = pose_mounting_jacobian(kStart, kLever_m);
  const Pose by_mounting = K * u::sub_block(joint, u::mounting);
  u::sub_block(joint, u::pose) = by_mounting * K.transpose();
  u::sub_block(joint, u::pose, u::mounting) = by_mounting;
  u::sub_block(joint, u::mounting, u::pose) = by_mounting.transpose();
  EXPECT_LT(covariance.in_world_frame(joint, Eigen::Vector3d::Zero()).cwiseAbs().maxCoeff(), 1e-18);
  EXPECT_GT((in_world(covariance, joint).topLeftCorner<3, 3>().trace()), 1e-3);
}

TEST(WorldCovariance, DriftGrowsAlongTheUnconstrainedDirection) {
  WorldCovariance covariance(without_tilt(), kStart, kLever_m);
  Eigen::Matrix<double, 6, 1> along = Eigen::Matrix<double, 6, 1>::Zero();
  along[1] = 1.0;
  covariance.add_drift(2.0, along);
  Pose expected = Pose::Zero();
  expected(1, 1) = 0.04;
  EXPECT_LT((in_world(covariance) - expected).cwiseAbs().maxCoeff(), 1e-15);
  along << 0.6, 0.0, 0.0, 0.8, 0.0, 0.0;  // of a direction that also rotates, only the translation counts
  covariance.add_drift(100.0, along);     // the deviation of a constrained direction is at most 3 m
  expected(0, 0) = 0.09 * 0.36;
  EXPECT_LT((in_world(covariance) - expected).cwiseAbs().maxCoeff(), 1e-15);
}

/// A body that rests during sweeps, without mounting error: a fraction d of the map has the error of the pose.
TEST(WorldCovariance, WhatIsInsertedMovesTheMapByItsShare) {
  std::vector<MotionSample> samples;
  for (int k = 0; k < 10; ++k) {
    MotionSample& sample = samples.emplace_back();
    sample.from_ns = k * 10'000'000;
    sample.time_ns = sample.from_ns + 10'000'000;
    sample.f_I_m_s2 = {0.0, 0.0, 9.8};
  }
  SweepTrajectory trajectory;
  const Registration::Estimate rest;
  ASSERT_TRUE(trajectory.build(rest.state, samples, 100'000'000, {0.0, 0.0, -9.8}, rest.saturation_deficit_rad_s).ok());
  Matrix errors = Matrix::Zero();
  u::variances(errors, u::position).setConstant(0.01);
  u::variances(errors, u::attitude).setConstant(0.0004);
  u::variances(errors, u::velocity).setConstant(0.25);
  WorldCovariance covariance(without_tilt(), kStart, kLever_m);
  covariance.add_inserted_sweep(0.2, trajectory, errors, kLever_m);
  covariance.add_inserted_sweep(0.1, trajectory, errors, kLever_m);
  const Pose P = in_world(covariance);
  const double d2 = 0.2 * 0.2 + 0.1 * 0.1;
  // in the middle of the sweep, 50 ms after the errors: the velocity's part, and the effect of a tilt on the force by
  // then
  const double by_tilt_m = 0.5 * 9.8 * 0.05 * 0.05;
  EXPECT_NEAR(P(2, 2), d2 * (0.01 + 0.25 * 0.0025), 1e-12);
  EXPECT_NEAR(P(0, 0), d2 * (0.01 + 0.25 * 0.0025 + 0.0004 * by_tilt_m * by_tilt_m), 1e-9);
  EXPECT_NEAR(P(4, 4), d2 * 0.0004, 1e-15);
}

/// The errors of successive sweeps have common causes, so the error grows in proportion to the distance.
TEST(WorldCovariance, TheScaleOfTheMapMovesDistantPositions) {
  const WorldCovariance covariance(without_tilt(), kStart, kLever_m, kPlace_W_m);
  const auto sigma_m = [&](double x_m) {
    const Eigen::Vector3d p_WI_m = kPlace_W_m + Eigen::Vector3d(x_m, 0.0, 0.0);
    return std::sqrt(covariance.in_world_frame(Matrix::Zero(), p_WI_m)(0, 0));
  };
  EXPECT_EQ(sigma_m(0.0), 0.0);
  EXPECT_NEAR(sigma_m(1000.0), 3.0, 1e-9);
}

/// A rotation of the map where the robot extended it moves the robot's later positions in proportion to the path.
TEST(WorldCovariance, TheMapsRotationMovesLaterPositions) {
  WorldCovariance covariance(without_tilt(), kStart, Eigen::Vector3d::Zero());
  Matrix errors = Matrix::Zero();
  const auto extend = [&](double x_m, double yaw_sigma_rad) {
    MotionState start;
    start.p_WI_m.x() = x_m;
    MotionSample sample;
    sample.time_ns = 100'000'000;
    sample.f_I_m_s2 = {0.0, 0.0, 9.8};
    SweepTrajectory trajectory;
    EXPECT_TRUE(trajectory.build(start, {&sample, 1}, sample.time_ns, {0.0, 0.0, -9.8}).ok());
    errors(5, 5) = yaw_sigma_rad * yaw_sigma_rad;
    covariance.add_inserted_sweep(1.0, trajectory, errors, Eigen::Vector3d::Zero());
  };
  extend(0.0, 0.01);
  EXPECT_LT(covariance.in_world_frame(Matrix::Zero(), Eigen::Vector3d::Zero())(1, 1), 1e-12);
  extend(100.0, 0.0);
  const Pose P = covariance.in_world_frame(Matrix::Zero(), {100.0, 0.0, 0.0});
  EXPECT_NEAR(std::sqrt(P(1, 1)), 1.0, 0.01);
  EXPECT_NEAR(std::sqrt(P(5, 5)), 0.01, 1e-4);
  EXPECT_EQ(covariance.sigma_in_map_m(Matrix::Zero(), {100.0, 0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace tumble::mapping
