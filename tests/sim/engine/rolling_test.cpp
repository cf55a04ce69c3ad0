// SPDX-License-Identifier: BSD-3-Clause
#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

const double kRadius_m = 0.145;

Vector3d centre_velocity(const Truth& truth, std::size_t k) {
  const Vector3d w_W = truth.q_WB[k] * truth.w_WB_B_rad_s[k];
  return truth.v_WB_m_s[k] + w_W.cross(truth.q_WB[k] * truth.p_BG_m);
}
Vector3d rolling_velocity(const Truth& truth, std::size_t k) {
  return kRadius_m * (truth.q_WB[k] * truth.w_WB_B_rad_s[k]).cross(Vector3d::UnitZ());
}

double share(const Truth& truth, ContactLabel label) {
  return static_cast<double>(std::count(truth.label.begin(), truth.label.end(), label)) /
         static_cast<double>(truth.label.size());
}

TEST(Rolling, ObeysVelocityEqualsRadiusTimesRate) {
  Situation situation = roll_along(4.5);
  situation.robot.values.set("inner_x_m", 0.008);
  situation.robot.values.set("inner_z_m", -0.01);
  const Truth truth = simulate(built(situation)).truth;
  double path_length_m = 0.0, rolled_m = 0.0;
  Vector3d difference = Vector3d::Zero();
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    const Vector3d v = centre_velocity(truth, k), r = rolling_velocity(truth, k);
    path_length_m += v.head<2>().norm() * 0.0005;
    rolled_m += r.head<2>().norm() * 0.0005;
    difference += (v - r) * 0.0005;
  }
  EXPECT_NEAR(path_length_m, 1.0, 0.02);
  EXPECT_NEAR(rolled_m / path_length_m, 1.0, 1e-3);
  EXPECT_LT(difference.head<2>().norm(), 1e-3 * path_length_m);
  EXPECT_EQ(share(truth, ContactLabel::slip) + share(truth, ContactLabel::slide), 0.0);
  EXPECT_GT(share(truth, ContactLabel::grip), 0.99);
  EXPECT_LT(centre_velocity(truth, 0).norm(), 0.005);
  EXPECT_LT(centre_velocity(truth, truth.q_WB.size() - 1).norm(), 0.005);
}

TEST(Rolling, SlideTurnsToGripAfterTheTimeOfCoulombsLaw) {
  Situation situation = roll_along(1.0);
  situation.world.values.set("friction", 0.1);
  engine::World world = engine::compose(resolve(situation), models_folder());
  engine::Physics physics(world);
  BodyState state;
  state.p_WB_m = {0, 0, kRadius_m};
  physics.set_state(state);
  for (int k = 0; k < 1000; ++k) physics.step({});  // settles into the contact
  state = physics.state();
  state.time_s = 0.0;
  state.v_WB_m_s = {1.0, 0, 0};
  physics.set_state(state);
  double gripped_s = -1.0;
  while (gripped_s < 0.0 && physics.state().time_s < 1.0) {
    physics.step({});
    const BodyState now = physics.state();
    const double slip = now.v_WB_m_s.x() - kRadius_m * (now.q_WB * now.w_WB_B_rad_s).y();
    if (slip < 0.005) gripped_s = now.time_s;
  }
  const double inertia = world.model->body_inertia[3 * world.robot_body],
               mass = world.model->body_mass[world.robot_body];
  // v0 - remaining slip = mu g t (1 + m r^2 / I)
  const double expected_s = 0.995 / (0.1 * 9.80665 * (1.0 + mass * kRadius_m * kRadius_m / inertia));
  EXPECT_NEAR(gripped_s, expected_s, 0.005 * expected_s);  // measured 0.2 %
}

/// Returns a path over one patch, with a burst of spin there.
Situation over_a_patch(double spin_ratio) {
  Situation situation = roll_along(4.5);
  situation.world.values.set("patch_1_x_m", 0.5);
  situation.world.values.set("patch_1_half_x_m", 0.2);
  situation.world.values.set("patch_1_half_y_m", 0.3);
  situation.world.values.set("patch_1_friction", 0.04);
  situation.motion.values.set("patch_1_spin_ratio", spin_ratio);
  return situation;
}

TEST(Patch, BurstSpinsTheSphereThereAndNowhereElse) {
  const Truth truth = simulate(built(over_a_patch(2.2))).truth;
  double rolled_m = 0.0;
  std::size_t labelled = 0;
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    rolled_m += rolling_velocity(truth, k).x() * 0.0005;
    const double x = truth.p_WB_m[k].x();
    if (truth.label[k] == ContactLabel::slip) {
      ++labelled;
      ASSERT_GT(x, 0.28);
      ASSERT_LT(x, 0.85);
    }
  }
  EXPECT_GT(labelled * 0.0005, 0.3);
  EXPECT_GT(rolled_m, 1.2);  // the path is 1 m, so pure rolling has a large error
  EXPECT_NEAR(truth.p_WB_m.back().x(), 1.0, 0.02);
}

TEST(Patch, BrakedRotationSlides) {
  const Truth truth = simulate(built(over_a_patch(0.3))).truth;
  EXPECT_GT(share(truth, ContactLabel::slide) * 4.5, 0.2);
  EXPECT_GT(share(truth, ContactLabel::slide), 5.0 * share(truth, ContactLabel::slip));
}

TEST(Patch, WithoutABurstTheFrictionOfThePatchIsInForce) {
  engine::World world = engine::compose(resolve(over_a_patch(1.0)), models_folder());
  ASSERT_EQ(world.patches.size(), 1u);
  engine::Physics physics(world);
  BodyState state;
  state.p_WB_m = {0.5, 0, kRadius_m};
  physics.set_state(state);
  for (int k = 0; k < 1000; ++k) physics.step({});
  std::vector<ContactTruth> contacts;
  for (int k = 0; k < 100; ++k) physics.step({{20.0, 0, 0}, {0, 0, 0}});  // far more than mu m g = 1.6 N
  const BodyState now = physics.state();
  // only friction turns a sliding sphere: I w' = mu m g r
  const double inertia = world.model->body_inertia[3 * world.robot_body];
  EXPECT_NEAR((now.q_WB * now.w_WB_B_rad_s).y(), 0.04 * 4.2 * 9.80665 * kRadius_m / inertia * 0.05, 0.03);
}

}  // namespace
}  // namespace tumble::sim
