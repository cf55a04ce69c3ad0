// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/path.hpp"
#include "sim/motion/tremor.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/sphere/free_sphere.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> path(const PathPlan& plan, std::uint64_t seed = 1) {
  Stream stream(seed, "test");
  return plan_path(plan, stream);
}

double length_m(const std::vector<Vector2d>& nodes) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) sum_m += (nodes[i] - nodes[i - 1]).norm();
  return sum_m;
}

TEST(Path, HasItsLengthShapeAndHeading) {
  for (const PathShape shape : {PathShape::line, PathShape::l, PathShape::eight, PathShape::free}) {
    const auto nodes = path({shape, 3.0});
    EXPECT_NEAR(length_m(nodes), 3.0, 1e-3);
    Vector2d low = nodes[0], high = nodes[0];
    for (const Vector2d& node : nodes) {
      low = low.cwiseMin(node);
      high = high.cwiseMax(node);
    }
    EXPECT_LT((low + high).norm(), 1e-12);  // centred
  }
  const auto line = path({PathShape::line, 2.0, std::numbers::pi / 2});
  EXPECT_LT((line.back() - line.front() - Vector2d(0, 2.0)).norm(), 1e-12);
  const auto l = path({PathShape::l, 2.0});
  EXPECT_LT((l.back() - l.front() - Vector2d(1.0, 1.0)).norm(), 1e-12);
  const auto eight = path({PathShape::eight, 5.0});
  EXPECT_LT((eight.back() - eight.front()).norm(), 1e-12);
  EXPECT_LT((eight[eight.size() / 2] - eight.front()).norm(), 0.01);  // passes through its crossing
  EXPECT_GT((path({PathShape::free, 3.0}, 1).back() - path({PathShape::free, 3.0}, 2).back()).norm(), 0.01);
  const auto swaying = path({PathShape::line, 4.0, 0.0, 0.3, 2.0});
  double widest_m = 0.0;
  for (const Vector2d& node : swaying) widest_m = std::max(widest_m, std::abs(node.y()));
  EXPECT_NEAR(widest_m, 0.3, 0.01);
}

TEST(Tremor, HasItsRootMeanSquareAndIsSmooth) {
  Stream stream(3, "test");
  const Tremor tremor(stream, 2.0, 0.7, 9.0);
  double power = 0.0, steepest = 0.0;
  constexpr int kSamples = 400000;
  for (int k = 0; k < kSamples; ++k) {
    power += tremor.at(0.001 * k) * tremor.at(0.001 * k);
    steepest = std::max(steepest, std::abs(tremor.at(0.001 * (k + 1)) - tremor.at(0.001 * k)) / 0.001);
  }
  EXPECT_NEAR(std::sqrt(power / kSamples), 2.0, 0.05);  // 400 s of 0.7 Hz
  // eight waves of amplitude a_i = c / f_i have a slope of at most 16 pi c, and c <= 2 * 9 Hz * sqrt(2 / 8)
  EXPECT_LT(steepest, 16.0 * std::numbers::pi * 9.0);
}

Situation along(double shape) {
  Situation situation = roll_along(9.0);
  situation.motion.type = "hand_path";
  situation.motion.values = {};
  situation.motion.values.set("rest_s", 0.5);
  situation.motion.values.set("shape", shape);
  situation.motion.values.set("length_m", 3.0);
  situation.motion.values.set("tremor_n", 1.0);
  situation.motion.values.set("tremor_nm", 0.02);
  situation.motion.values.set("stroke_share", 0.1);
  return situation;
}

Vector3d centre_m(const Truth& truth, std::size_t k) {
  return truth.p_WB_m[k] + truth.q_WB[k] * truth.p_BG_m;
}

TEST(HandPath, LeadsTheSphereAlongThePathFromRestToRest) {
  for (const double shape : {1.0, 2.0}) {
    const Truth truth = simulate(built(along(shape))).truth;
    double path_length_m = 0.0;
    for (std::size_t k = 1; k < truth.q_WB.size(); ++k)
      path_length_m += (centre_m(truth, k) - centre_m(truth, k - 1)).head<2>().norm();
    // corners are rounded: averaging over 0.3 s at 0.6 m/s shortens the path by 4 cm; the tremor lengthens it a little
    EXPECT_NEAR(path_length_m, 3.0, 0.08) << shape;
    const Vector3d moved = centre_m(truth, truth.q_WB.size() - 1) - centre_m(truth, 0);
    const Vector3d aim = shape == 1.0 ? Vector3d(1.5, 1.5, 0.0) : Eigen::Vector3d::Zero();
    EXPECT_LT((moved - aim).norm(), 0.02);
    EXPECT_LT(truth.v_WB_m_s.front().norm(), 0.005);
    EXPECT_LT(truth.v_WB_m_s.back().norm(), 0.005);
    EXPECT_EQ(count(truth, ContactLabel::grip), truth.label.size());
  }
}

TEST(HandPath, IsUnsteadyAsItsSeedSays) {
  Situation situation = along(0.0);
  situation.duration_s = 2.0;
  const Truth one = simulate(built(situation)).truth;
  EXPECT_EQ(simulate(built(situation)).truth.p_WB_m, one.p_WB_m);
  situation.motion.values.set("hand_seed", 7.0);
  const Truth other = simulate(built(situation)).truth;
  EXPECT_GT((other.p_WB_m.back() - one.p_WB_m.back()).norm(), 1e-3);
  EXPECT_LT((other.p_WB_m[600] - one.p_WB_m[600]).norm(), 1e-9);  // a hand at rest has no tremor
}

/// Returns a path with ice on the middle of its line.
Situation over_ice(double push, double spin) {
  Situation situation = along(0.0);
  situation.duration_s = 7.0;
  situation.world.values.set("patch_1_half_x_m", 0.3);
  situation.world.values.set("patch_1_half_y_m", 0.3);
  situation.world.values.set("patch_1_friction", 0.02);
  situation.motion.values.set("patch_1_push_ratio", push);
  situation.motion.values.set("patch_1_spin_ratio", spin);
  situation.motion.values.set("burst_s", 5.0);
  return situation;
}

TEST(HandPath, APushThroughTheCentreOnIceSlides) {
  const Truth truth = simulate(built(over_ice(2.2, 1.0))).truth;
  EXPECT_GT(static_cast<double>(count(truth, ContactLabel::slide)) * 0.0005, 0.15);
  // negative control: without the push the sphere hardly slides on the same ice
  const Truth calm = simulate(built(over_ice(1.0, 1.0))).truth;
  EXPECT_LT(static_cast<double>(count(calm, ContactLabel::slide)) * 0.0005, 0.05);
}

TEST(HandPath, ABurstOfTorqueOnIceSpins) {
  const Truth truth = simulate(built(over_ice(1.0, 5.0))).truth;
  EXPECT_GT(static_cast<double>(count(truth, ContactLabel::slip)) * 0.0005, 0.5);
  double fastest_rad_s = 0.0;
  for (const Vector3d& w : truth.w_WB_B_rad_s) fastest_rad_s = std::max(fastest_rad_s, w.norm());
  EXPECT_NEAR(fastest_rad_s, 5.0 * 0.6 / kRadius_m, 0.35 * 5.0 * 0.6 / kRadius_m);  // pushes vary the speed
}

}  // namespace
}  // namespace tumble::sim
