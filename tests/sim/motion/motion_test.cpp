// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_type.hpp"

#include "sim/compose.hpp"
#include "sim/motion/rigid_body.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

Situation moved_by(const std::string& type, double duration_s) {
  Situation situation = tumble_down(duration_s, 2000.0);
  situation.world.values.set("relief_m", 0.0);
  situation.world.values.set("bump_height_m", 0.0);
  situation.world.values.set("drop_m", 0.2);
  situation.world.values.set("slope_rad", 0.1);
  situation.motion = {type, {}};
  situation.motion.values.set("rest_s", 0.5);
  return situation;
}

double largest_step_m_s(const Truth& truth) {
  double largest = 0.0;
  for (std::size_t k = 1; k < truth.v_WB_m_s.size(); ++k)
    largest = std::max(largest, (truth.v_WB_m_s[k] - truth.v_WB_m_s[k - 1]).norm());
  return largest;
}

TEST(RaisedCosine, HasUnitIntegralAndVanishesOutside) {
  double sum = 0.0;
  for (int i = 0; i <= 1000; ++i) sum += raised_cosine(i / 1000.0) / 1000.0;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_EQ(raised_cosine(-0.1), 0.0);
  EXPECT_EQ(raised_cosine(1.1), 0.0);
}

TEST(Throw, LeavesTheHandWithTheStatedVelocityAndSpin) {
  Situation situation = moved_by("throw", 1.6);
  situation.motion.values.set("velocity_m_s", 3.0);
  situation.motion.values.set("lift_m_s", 4.0);
  situation.motion.values.set("direction_rad", 0.2);
  situation.motion.values.set("spin_forward_rad_s", 0.0);
  situation.motion.values.set("spin_up_rad_s", 9.0);
  const Truth truth = simulate(built(situation)).truth;
  const std::size_t released = 1601;  // 0.5 s of rest and 0.3 s of throw
  const Vector3d expected(3.0 * std::cos(0.2), 3.0 * std::sin(0.2), 4.0);
  EXPECT_NEAR((truth.v_WB_m_s[released] - expected).norm(), 0.0, 0.02);  // the hand sags by 1 mm; one step of gravity
  EXPECT_NEAR((truth.w_WB_B_rad_s[released] - Vector3d(0, 0, 9.0)).norm(), 0.0, 0.02);
  // the path is then a parabola: there is no force at the centre of mass until the body lands, 0.8 s later
  EXPECT_NEAR(truth.f_B_m_s2[released + 1000].norm(), 0.0, 1e-6);
  EXPECT_EQ(truth.label[released + 1000], ContactLabel::air);
}

TEST(Throw, HoldsStillBeforeAndNeverJumps) {
  Situation situation = moved_by("throw", 1.2);
  situation.motion.values.set("height_m", 1.3);
  const Truth truth = simulate(built(situation)).truth;
  for (std::size_t k = 0; k <= 1000; k += 50) {
    ASSERT_LT(truth.v_WB_m_s[k].norm(), 1e-3) << k;
    ASSERT_NEAR(truth.f_B_m_s2[k].norm(), 9.80665, 0.05) << k;
  }
  EXPECT_EQ(truth.contacts.size(), 0u) << "it is in the air until it lands";
  EXPECT_LT(largest_step_m_s(truth), 0.05);  // 5.7 m/s over 0.3 s as a raised cosine: 0.019 m/s a step
}

TEST(Drop, FallsFreelyFromTheStatedHeight) {
  Situation situation = moved_by("drop", 1.4);
  situation.motion.values.set("height_m", 1.5);
  situation.motion.values.set("roll_rad", 0.6);
  situation.motion.values.set("pitch_rad", -0.4);
  situation.motion.values.set("release_s", 0.0);
  const Truth truth = simulate(built(situation)).truth;
  ASSERT_FALSE(truth.contacts.empty());
  const double landed_s = static_cast<double>(truth.contacts.front().time_ns) * 1e-9;
  EXPECT_NEAR(landed_s - 0.5, std::sqrt(2.0 * 1.5 / 9.80665), 0.005);
  EXPECT_LT(truth.w_WB_B_rad_s[1500].norm(), 1e-6) << "nothing turns it in the air";
}

TEST(Drop, MayStartAwayFromTheStart) {
  Situation situation = moved_by("drop", 1.0);
  situation.motion.values.set("forward_m", 2.0);
  const Truth away = simulate(built(situation)).truth;
  situation.motion.values.set("forward_m", 0.0);
  const Truth near = simulate(built(situation)).truth;
  EXPECT_NEAR((away.p_WB_m[0] - near.p_WB_m[0] - Vector3d(2, 0, 0)).norm(), 0.0, 1e-9);
}

TEST(Twirl, SpinsAboutXInStrokesAndKeepsTheGripInTheHand) {
  Situation situation = moved_by("twirl", 8.0);
  for (const auto& [name, value] :
       {std::pair{"spin_rad_s", 12.0}, std::pair{"spin_spread_rad_s", 0.0}, std::pair{"interval_s", 1.5},
        std::pair{"twist_rad", 0.0}, std::pair{"sway_rad", 0.02}, std::pair{"sway_m", 0.005},
        std::pair{"grip_x_m", 0.05}, std::pair{"grip_y_m", -0.08}, std::pair{"hand_seed", 3.0}}) {
    situation.motion.values.set(name, value);
  }
  const Truth truth = simulate(built(situation)).truth;
  const auto grip = [&](std::size_t k) {
    return Vector3d(truth.p_WB_m[k] + truth.q_WB[k] * Vector3d(0.05, -0.08, 0.0));
  };
  double fastest = 0.0, farthest = 0.0, beside = 0.0;
  int strokes = 0;
  bool within = false;
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    const Vector3d& w = truth.w_WB_B_rad_s[k];
    fastest = std::max(fastest, std::abs(w.x()));
    beside = std::max(beside, w.tail<2>().norm());
    farthest = std::max(farthest, (grip(k) - grip(0)).norm());
    strokes += !within && std::abs(w.x()) > 6.0;
    within = std::abs(w.x()) > (within ? 3.0 : 6.0);
    ASSERT_EQ(truth.label[k], ContactLabel::air);
  }
  EXPECT_NEAR(fastest, 12.0, 0.5);
  EXPECT_GE(strokes, 3);  // within 7 s, each 1.1 to 1.9 s after the last
  EXPECT_LE(strokes, 7);
  EXPECT_LT(beside, 1.0);
  EXPECT_LT(farthest, 0.05);
  EXPECT_LT(largest_step_m_s(truth), 0.05);  // without jumps: at most 100 m/s^2
}

// without sway the path is x = a sin u, y = b sin 2u, walked `loops` times over 2 pi, with the heading along it
TEST(Stroll, WalksTheEightAndStopsWhereItShould) {
  Situation situation = moved_by("stroll", 20.0);
  for (const auto& [name, value] :
       {std::pair{"rest_s", 1.5}, std::pair{"half_length_m", 2.0}, std::pair{"half_width_m", 1.0},
        std::pair{"loops", 0.75}, std::pair{"speed_m_s", 1.2}, std::pair{"heading_rad", 0.5},
        std::pair{"sway_rad", 0.0}, std::pair{"sway_m", 0.0}, std::pair{"step_m", 0.0}}) {
    situation.motion.values.set(name, value);
  }
  const Truth truth = simulate(built(situation)).truth;
  const Eigen::AngleAxisd heading(0.5, Vector3d::UnitZ());
  double fastest = 0.0, off = 0.0;
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    const Vector3d walked = heading.inverse() * (truth.p_WB_m[k] - truth.p_WB_m[0]);
    // the equation of the curve is (y / b)^2 = 4 (x / a)^2 (1 - (x / a)^2)
    const double x = walked.x() / 2.0, y = walked.y();
    off = std::max({off, std::abs(y * y - 4.0 * x * x * (1.0 - x * x)), std::abs(walked.z())});
    fastest = std::max(fastest, truth.v_WB_m_s[k].norm());
    ASSERT_EQ(truth.label[k], ContactLabel::air);
  }
  EXPECT_LT(off, 0.01);
  EXPECT_NEAR(fastest, 1.2, 0.02);
  EXPECT_NEAR((heading.inverse() * (truth.p_WB_m.back() - truth.p_WB_m[0]) - Vector3d(-2.0, 0.0, 0.0)).norm(), 0.0,
              5e-3);
  EXPECT_LT(largest_step_m_s(truth), 0.05);
}

TEST(Swing, LeadsAsideAndUpHoldsAndLetsGo) {
  Situation situation = moved_by("swing", 8.0);
  situation.world = {"floor", {}};
  situation.robot = {"pendulum", {}};
  situation.sensors.clear();
  for (const auto& [name, value] : {std::pair{"lift_s", 1.0}, std::pair{"hold_s", 1.0}, std::pair{"aside_m", 0.3},
                                    std::pair{"up_m", 0.3}, std::pair{"spread_m", 0.0}, std::pair{"sideways_m", 0.0},
                                    std::pair{"other_side_share", 0.0}, std::pair{"interval_s", 4.5}}) {
    situation.motion.values.set(name, value);
  }
  for (const char* name : {"hinge_damping_nm_s", "hinge_friction_nm"}) situation.robot.values.set(name, 0.004);
  const Truth truth = simulate(built(situation)).truth;
  const auto at = [](double time_s) { return static_cast<std::size_t>(std::lround(time_s / 0.0005)); };
  EXPECT_EQ((truth.p_WB_m[at(0.49)] - truth.p_WB_m[0]).norm(), 0.0);
  // at 2.4 s the hand holds the pendulum: its weight pulls the hand's spring (200 N/m at 0.9 kg) down by at most 4.4 cm
  const Vector3d held = truth.p_WB_m[at(2.4)] - truth.p_WB_m[0];
  EXPECT_NEAR((held - Vector3d(0.3, 0.0, 0.3)).norm(), 0.0, 0.05);
  EXPECT_LT(truth.v_WB_m_s[at(2.4)].norm(), 0.3);
  // at 2.5 s the hand releases the pendulum: it falls, then swings through to the other side without a jump
  EXPECT_LT(truth.p_WB_m[at(2.75)].z(), truth.p_WB_m[at(2.5)].z() - 0.1);
  double least_x_m = 0.0;
  for (std::size_t k = at(2.6); k < at(4.0); ++k) least_x_m = std::min(least_x_m, truth.p_WB_m[k].x());
  EXPECT_LT(least_x_m, -0.1);
  EXPECT_LT(largest_step_m_s(truth), 0.2);  // 400 m/s^2 at the whip's end
  // the motion repeats 4.05 to 4.95 s after the first time
  const double again_m = (truth.p_WB_m[at(6.5)] - truth.p_WB_m[0] - Vector3d(0.3, 0.0, 0.3)).norm();
  EXPECT_LT(again_m, 0.1);
}

Situation launched(double duration_s) {
  Situation situation = moved_by("launch", duration_s);
  situation.world = {"floor", {}};
  for (const auto& [name, value] :
       {std::pair{"height_m", 1000.0}, std::pair{"elevation_rad", -1.57079632679}, std::pair{"drag_1_m", 0.02}}) {
    situation.motion.values.set(name, value);
  }
  return situation;
}

TEST(Launch, FallsAtTheTerminalSpeedAndSpinsAsTheFinsAreCanted) {
  Situation situation = launched(12.0);
  situation.motion.values.set("roll_rad_m", -2.0);
  situation.motion.values.set("roll_damping_1_m", 0.1);
  const Truth truth = simulate(built(situation)).truth;
  const double terminal_m_s = std::sqrt(9.80665 / 0.02);
  EXPECT_NEAR(truth.v_WB_m_s.back().z(), -terminal_m_s, 0.01);
  EXPECT_NEAR((truth.w_WB_B_rad_s.back() - Vector3d(-2.0 * terminal_m_s, 0.0, 0.0)).norm(), 0.0, 0.1);
  EXPECT_NEAR(truth.f_B_m_s2.back().x(), -9.80665, 0.01) << "the air drag carries the weight";
}

TEST(Launch, ThrustAndParachuteActAsStated) {
  Situation situation = launched(3.0);
  for (const auto& [name, value] :
       {std::pair{"elevation_rad", 1.57079632679}, std::pair{"drag_1_m", 0.0}, std::pair{"thrust_m_s2", 60.0},
        std::pair{"burn_s", 1.0}, std::pair{"parachute_s", 1.5}, std::pair{"parachute_drag_1_m", 0.1}}) {
    situation.motion.values.set(name, value);
  }
  const Truth truth = simulate(built(situation)).truth;
  const auto at = [](double time_s) { return static_cast<std::size_t>(std::lround(time_s / 0.0005)); };
  EXPECT_NEAR(truth.f_B_m_s2[at(1.0)].x(), 60.0, 1e-6);
  EXPECT_NEAR(truth.v_WB_m_s[at(1.6)].z(), 60.0 * 0.95 - 1.1 * 9.80665, 0.1);  // thrust rises and falls in 0.05 s each
  EXPECT_NEAR(truth.f_B_m_s2[at(1.9)].norm(), 0.0, 1e-6);
  const std::size_t open = at(2.4);
  EXPECT_NEAR(truth.f_B_m_s2[open].norm(), 0.1 * truth.v_WB_m_s[open].squaredNorm(), 0.2);
}

TEST(Clearance, IsThatOfTheTurnedRobot) {
  const engine::World world = engine::compose(resolve(tumble_down(1.0, 100.0)), models_folder());
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond head_down(Eigen::AngleAxisd(3.141592653589793, Vector3d::UnitX()));
  const double low_m = clearance_m(*world.model, world.robot_body, upright, 0.0);
  const double high_m = clearance_m(*world.model, world.robot_body, head_down, 0.0);
  double lowest_m = 0.0, highest_m = 0.0;  // of the struts' axes, by the compiled model
  for (int g = 0; g < world.model->ngeom; ++g) {
    if (world.model->geom_type[g] != mjGEOM_CAPSULE) continue;
    const double radius_m = world.model->geom_size[3 * g], z_m = world.model->geom_pos[3 * g + 2];
    const mjtNum* q = world.model->geom_quat + 4 * g;
    const double half_m = std::abs(1 - 2 * (q[1] * q[1] + q[2] * q[2])) * world.model->geom_size[3 * g + 1];
    lowest_m = std::min(lowest_m, z_m - half_m - radius_m);
    highest_m = std::max(highest_m, z_m + half_m + radius_m);
  }
  EXPECT_NEAR(low_m, -lowest_m, 1e-9);
  EXPECT_NEAR(high_m, highest_m, 1e-9);
  EXPECT_GT(std::abs(low_m - high_m), 0.01) << "the cage is not symmetric about its centre of mass";
}

}  // namespace
}  // namespace tumble::sim
