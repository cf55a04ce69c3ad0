// SPDX-License-Identifier: BSD-3-Clause
// Compares state estimates with closed forms, and with the nonlinear relations that they linearise.
#include "estimator/src/mapping/state_estimate.hpp"

#include "estimator/src/common/dense.hpp"
#include "estimator/src/mapping/unknowns.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::mapping {
namespace {

namespace u = unknowns;
using Matrix = Registration::Matrix;

constexpr double kForce_m_s2 = 4.0, kSegment_s = 0.5;

/// Returns half a second in which the IMU does not rotate and measures a force along x; the state estimate contains
/// gravity.
std::vector<MotionSample> pushed() {
  std::vector<MotionSample> samples;
  for (int k = 0; k < 50; ++k) {
    MotionSample& sample = samples.emplace_back();
    sample.from_ns = k * 10'000'000;
    sample.time_ns = sample.from_ns + 10'000'000;
    sample.f_I_m_s2 = {kForce_m_s2, 0.0, 0.0};
  }
  return samples;
}

SweepTrajectory along(const StateEstimate& state_estimate, const std::vector<MotionSample>& samples, TimeNs end_ns) {
  SweepTrajectory trajectory;
  const Registration::Estimate& mean = state_estimate.mean;
  EXPECT_TRUE(
      trajectory.build(mean.state, samples, end_ns, mean.calibration.gravity_W_m_s2, mean.saturation_deficit_rad_s)
          .ok());
  return trajectory;
}

StateEstimate uncertain() {
  StateEstimate state_estimate;
  state_estimate.mean.state.v_WI_m_s = {1.0, 2.0, 3.0};
  u::variances(state_estimate.prior_weight_covariance, u::position).setConstant(0.01);
  u::variances(state_estimate.prior_weight_covariance, u::attitude).setConstant(0.04);
  u::variances(state_estimate.prior_weight_covariance, u::velocity).setConstant(0.09);
  u::variances(state_estimate.prior_weight_covariance, u::gravity).setConstant(0.16);
  state_estimate.state_error_covariance = 4.0 * state_estimate.prior_weight_covariance;
  return state_estimate;
}

StateEstimate carried(const StateEstimate& state_estimate, const std::vector<MotionSample>& samples, TimeNs end_ns) {
  const SweepTrajectory trajectory = along(state_estimate, samples, end_ns);
  StateEstimate end;
  at_end(state_estimate, trajectory, unknowns_at(trajectory, trajectory.duration_s()), end_ns, end);
  return end;
}

/// Bit for bit, for a covariance without zeros.
TEST(Unknowns, PoseAndMountingAreThoseOfTheWholeProduct) {
  const std::vector<MotionSample> samples = pushed();
  const Matrix F = unknowns_at(along(uncertain(), samples, 500'000'000), 0.37);
  Matrix root;
  for (int i = 0; i < root.size(); ++i) root(i) = std::sin(1.0 + 0.7 * i);
  Matrix errors = root * root.transpose();
  make_symmetric(errors);
  const Matrix whole = F * errors * F.transpose(), part = propagate_pose_and_mounting(F, errors);
  EXPECT_EQ(u::sub_block(part, u::pose), u::sub_block(whole, u::pose));
  EXPECT_EQ(u::sub_block(part, u::pose, u::mounting), u::sub_block(whole, u::pose, u::mounting));
  EXPECT_EQ(u::sub_block(part, u::mounting, u::pose), u::sub_block(whole, u::mounting, u::pose));
  EXPECT_EQ(u::sub_block(part, u::mounting), u::sub_block(whole, u::mounting));
  EXPECT_NE(u::sub_block(part, u::pose), u::sub_block(errors, u::pose));  // F changed the state
}

TEST(Unknowns, BlocksCoverEachUnknownOnce) {
  Matrix count = Matrix::Zero();
  u::variances(count, u::position).array() += 1.0;
  u::variances(count, u::attitude).array() += 1.0;
  u::variances(count, u::velocity).array() += 1.0;
  u::variances(count, u::deficit).array() += 1.0;
  u::variances(count, u::mounting_rotation).array() += 1.0;
  u::variances(count, u::mounting_translation).array() += 1.0;
  u::variances(count, u::clock).array() += 1.0;
  u::variances(count, u::gravity).array() += 1.0;
  EXPECT_EQ(count.diagonal(), Registration::Vector::Ones());
  Registration::Vector error = Registration::Vector::Zero();
  error[u::saturation_deficit_index(1, 2)] = 0.5;
  Registration::Estimate estimate;
  estimate.add(error);
  EXPECT_EQ(estimate.saturation_deficit_rad_s(1, 2), 0.5);
}

TEST(StateEstimate, AtTheEndOfAPushIsTheClosedForm) {
  const StateEstimate start = uncertain();
  const StateEstimate end = carried(start, pushed(), 500'000'000);
  const double t = kSegment_s, g = -9.80665;
  const Eigen::Vector3d force(kForce_m_s2, 0.0, g);
  EXPECT_LT((end.mean.state.p_WI_m - (start.mean.state.v_WI_m_s * t + 0.5 * t * t * force)).norm(), 1e-12);
  EXPECT_LT((end.mean.state.v_WI_m_s - (start.mean.state.v_WI_m_s + t * force)).norm(), 1e-12);
  // mapping.md (R11): a rotation displaces by the force's integrals, perpendicular to the force
  const double turned_m = 0.5 * kForce_m_s2 * t * t, turned_m_s = kForce_m_s2 * t;
  const double along_m2 = 0.01 + t * t * 0.09 + 0.25 * t * t * t * t * 0.16;
  const double across_m2 = along_m2 + turned_m * turned_m * 0.04;
  const Eigen::Vector3d position(u::variances(end.prior_weight_covariance, u::position));
  EXPECT_LT((position - Eigen::Vector3d(along_m2, across_m2, across_m2)).norm(), 1e-12);
  const Eigen::Vector3d velocity(u::variances(end.prior_weight_covariance, u::velocity));
  const double gained = 0.09 + t * t * 0.16, tilted = gained + turned_m_s * turned_m_s * 0.04;
  EXPECT_LT((velocity - Eigen::Vector3d(gained, tilted, tilted)).norm(), 1e-12);
  EXPECT_LT((end.state_error_covariance - 4.0 * end.prior_weight_covariance).norm(), 1e-12);
  EXPECT_EQ(end.mean.state.covariance, (u::sub_block(end.prior_weight_covariance, u::motion)));
  EXPECT_GT((end.prior_weight_covariance - start.prior_weight_covariance).norm(), 0.01);
}

TEST(StateEstimate, OverTwoHalvesIsThatOverTheWhole) {
  const std::vector<MotionSample> samples = pushed();
  const StateEstimate start = uncertain();
  const StateEstimate whole = carried(start, samples, 500'000'000);
  const StateEstimate half = carried(start, samples, 200'000'000);
  const std::vector<MotionSample> rest(samples.begin() + 20, samples.end());
  const StateEstimate both = carried(half, rest, 500'000'000);
  EXPECT_LT((both.prior_weight_covariance - whole.prior_weight_covariance).norm(), 1e-12);
  EXPECT_LT(both.mean.minus(whole.mean).norm(), 1e-12);
  EXPECT_GT((half.prior_weight_covariance - whole.prior_weight_covariance).norm(), 1e-3);
}

/// Returns the pose error of the IMU, and that of gravity in the map, for a mounting error `m` and a fixed lidar pose,
/// without derivatives.
Eigen::Matrix<double, 9, 1> displaced(const Eigen::Isometry3d& T_WI, const Eigen::Isometry3d& T_IL,
                                      const Eigen::Matrix<double, 6, 1>& m) {
  Eigen::Isometry3d T_true = T_IL;
  T_true.linear() = so3::exp(m.head<3>()).toRotationMatrix() * T_IL.linear();
  T_true.translation() += m.tail<3>();
  const Eigen::Isometry3d moved = T_WI * T_IL * T_true.inverse();
  const Eigen::Matrix3d turned = moved.linear() * T_WI.linear().transpose();
  const Eigen::Vector3d g(0.0, 0.0, -9.80665);
  Eigen::Matrix<double, 9, 1> out;
  out << moved.translation() - T_WI.translation(), so3::logarithm(Eigen::Quaterniond(turned)), turned * g - g;
  return out;
}

TEST(StateEstimate, AtTheStartHangsOnTheLidar) {
  LidarInertialOdometry::Params params;
  params.T_IL.translation() = Eigen::Vector3d(0.3, -0.2, 0.5);
  params.T_IL.linear() = so3::exp({0.3, 0.8, -0.4}).toRotationMatrix();
  params.mount_sigma_rad = 0.02;
  params.mount_sigma_m = 0.01;
  params.time_offset_sigma_s = 0.003;
  params.expert.gravity_sigma_m_s2 = 0.05;
  MotionState levelled;
  levelled.q_WI = so3::exp({0.2, -0.5, 0.0});
  levelled.covariance.diagonal().setConstant(0.001);
  const StateEstimate state_estimate = estimate_at_start(params, levelled);

  Eigen::Isometry3d T_WI = Eigen::Isometry3d::Identity();
  T_WI.linear() = levelled.q_WI.toRotationMatrix();
  Eigen::Matrix<double, Registration::kUnknowns, 6> by_mounting =
      Eigen::Matrix<double, Registration::kUnknowns, 6>::Zero();
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> step = kStep * Eigen::Matrix<double, 6, 1>::Unit(k);
    const Eigen::Matrix<double, 9, 1> by =
        (displaced(T_WI, params.T_IL, step) - displaced(T_WI, params.T_IL, -step)) / (2.0 * kStep);
    by_mounting.col(k).head<6>() = by.head<6>();
    by_mounting.col(k).tail<3>() = by.tail<3>();
    by_mounting(Registration::kFirstCalibrationUnknown + k, k) = 1.0;
  }
  Eigen::Matrix<double, 6, 1> variance;
  variance << Eigen::Vector3d::Constant(4e-4), Eigen::Vector3d::Constant(1e-4);
  Matrix expected = by_mounting * variance.asDiagonal() * by_mounting.transpose();
  u::variances(expected, u::motion).array() += 0.001;
  u::variances(expected, u::clock).array() += 9e-6;
  u::variances(expected, u::gravity) += Eigen::Vector3d(0.0025, 0.0025, 0.000025);
  EXPECT_LT((state_estimate.prior_weight_covariance - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(state_estimate.prior_weight_covariance, state_estimate.state_error_covariance);

  params.T_IL.translation().x() += 0.1;  // another lever arm gives another covariance
  EXPECT_GT((estimate_at_start(params, levelled).prior_weight_covariance - expected).cwiseAbs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace tumble::mapping
