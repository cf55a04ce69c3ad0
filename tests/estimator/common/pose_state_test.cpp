// SPDX-License-Identifier: BSD-3-Clause
// The test compares the pose of an attached frame with a closed form.
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

TEST(PoseState, OfAFrameWithALeverArmIsTheClosedForm) {
  constexpr double kArm_m = 0.3, kSigma_m = 0.01;
  const Vector3d sigma_rad(0.02, 0.03, 0.04), w_A_rad_s(0.0, 0.0, 2.0);
  PoseState pose;  // the x axis of A is the y axis of the world
  pose.time_ns = 7;
  pose.position_W_m = {1.0, 2.0, 3.0};
  pose.orientation_W = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ());
  pose.velocity_W_m_s = {5.0, 6.0, 7.0};
  pose.covariance.diagonal() << Vector3d::Constant(kSigma_m * kSigma_m), sigma_rad.cwiseAbs2();
  const Eigen::Isometry3d T_AB =
      Eigen::Translation3d(kArm_m, 0.0, 0.0) * Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX());
  const PoseState base = pose.transformed_to(T_AB, w_A_rad_s);

  EXPECT_EQ(base.time_ns, 7);
  EXPECT_TRUE(base.position_W_m.isApprox(Vector3d(1.0, 2.0 + kArm_m, 3.0), 1e-15));
  EXPECT_TRUE((base.orientation_W * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE((base.orientation_W * Vector3d::UnitZ()).isApprox(-Vector3d::UnitZ(), 1e-15));
  EXPECT_TRUE(base.velocity_W_m_s.isApprox(Vector3d(5.0 - w_A_rad_s.z() * kArm_m, 6.0, 7.0), 1e-15));
  // the arm is along y of the world: an error about z displaces the base along -x, an error about x along z
  Matrix6 expected = pose.covariance;
  const auto squared = [](double x) { return x * x; };
  expected(0, 0) += squared(kArm_m * sigma_rad.z());
  expected(2, 2) += squared(kArm_m * sigma_rad.x());
  expected(0, 5) = expected(5, 0) = -kArm_m * squared(sigma_rad.z());
  expected(2, 3) = expected(3, 2) = kArm_m * squared(sigma_rad.x());
  EXPECT_TRUE(base.covariance.isApprox(expected, 1e-14)) << base.covariance << "\n\n" << expected;

  const Vector3d w_B_rad_s = T_AB.linear().transpose() * w_A_rad_s;
  const PoseState back = base.transformed_to(T_AB.inverse(), w_B_rad_s);
  EXPECT_TRUE(back.position_W_m.isApprox(pose.position_W_m, 1e-14));
  EXPECT_TRUE(back.velocity_W_m_s.isApprox(pose.velocity_W_m_s, 1e-14));
  EXPECT_TRUE(back.covariance.isApprox(pose.covariance, 1e-12));
}

}  // namespace
}  // namespace tumble
