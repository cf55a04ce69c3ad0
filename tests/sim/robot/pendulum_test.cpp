// SPDX-License-Identifier: BSD-3-Clause
#include "sim/compose.hpp"
#include "sim/engine/jointed.hpp"
#include "sim/engine/physics.hpp"
#include "sim/simulate.hpp"
#include "sim/trial/trial.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kHeight_m = 1.3, kSegment_m = 0.25;

Situation hanging(double duration_s = 6.0) {
  Situation situation;
  situation.scenario = "test";
  situation.duration_s = duration_s;
  situation.world.type = "floor";
  situation.robot.type = "pendulum";
  situation.robot.values.set("segment_m", kSegment_m);
  situation.robot.values.set("height_m", kHeight_m);
  situation.motion.type = "swing";
  situation.motion.values.set("rest_s", 0.5);
  situation.sensors = {imu_at("imu", "imu", 2000.0)};
  return situation;
}

TEST(Pendulum, HangsWithItsImusXAxisUpAndItsZAlongTheHinge) {
  const Recording recording = simulate(built(hanging(4.0)));
  const Truth& truth = recording.truth;
  // the settling before the recording leaves the pendulum at its position
  EXPECT_NEAR((truth.p_WB_m[0] - Vector3d(0, 0, kHeight_m - 2.5 * kSegment_m)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(truth.q_WB[0].angularDistance(Eigen::Quaterniond::Identity()), 0.0, 1e-9);
  const ImuRecord& imu = recording.sensors.imus.at(0);
  EXPECT_NEAR((imu.accel_m_s2[0] - 9.80665 * Vector3d(std::cos(0.067), -std::sin(0.067), 0.0)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((imu.T_BI.linear() * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), 0.0, 1e-6);
  EXPECT_EQ(recording.sensors.robot, "pendulum");
}

// pose, velocity and rate of the lowest segment belong to one motion, and the segments above it constrain its position
TEST(Pendulum, TruthBelongsTogether) {
  const Truth truth = simulate(built(hanging())).truth;
  const double step_s = 1e-9 * static_cast<double>(truth.period_ns);
  const Vector3d hinge_W_m(0, 0, kHeight_m);
  double farthest_m = 0.0, fastest_rad_s = 0.0;
  for (std::size_t k = 1; k + 1 < truth.q_WB.size(); ++k) {
    const Vector3d v_m_s = (truth.p_WB_m[k + 1] - truth.p_WB_m[k - 1]) / (2.0 * step_s);
    const Eigen::AngleAxisd turn(truth.q_WB[k - 1].conjugate() * truth.q_WB[k + 1]);
    const Vector3d w_rad_s = turn.angle() * turn.axis() / (2.0 * step_s);
    // central differences err by dt^2 / 6 times the third derivative, some 1e4 m/s^3 and rad/s^3 in a whip
    ASSERT_NEAR((v_m_s - truth.v_WB_m_s[k]).norm(), 0.0, 2e-3) << k;
    ASSERT_NEAR((w_rad_s - truth.w_WB_B_rad_s[k]).norm(), 0.0, 2e-2) << k;
    farthest_m = std::max(farthest_m, (truth.p_WB_m[k] - hinge_W_m).norm());
    fastest_rad_s = std::max(fastest_rad_s, truth.w_WB_B_rad_s[k].norm());
    ASSERT_EQ(truth.label[k], ContactLabel::air);
  }
  EXPECT_LE(farthest_m, 2.5 * kSegment_m + 1e-9);
  EXPECT_GT(farthest_m, 2.4 * kSegment_m);
  EXPECT_GT(fastest_rad_s, 8.0);
}

TEST(Pendulum, FrictionSwingsItDown) {
  Situation situation = hanging();
  std::vector<double> swings_rad;
  for (const double damping : {0.0, 0.05}) {
    situation.robot.values.set("hinge_damping_nm_s", damping);
    Trial trial(built(situation));
    for (const char* hinge : {"hinge_1", "hinge_2"}) trial.set_joint(hinge, 0.2, 0.0);
    double largest_rad = 0.0;
    while (trial.state().time_s < 12.0) {
      trial.step();
      if (trial.state().time_s > 9.0) largest_rad = std::max(largest_rad, std::abs(trial.joint_rad("hinge_1")));
    }
    swings_rad.push_back(largest_rad);
  }
  EXPECT_GT(swings_rad[0], 0.15);
  EXPECT_LT(swings_rad[1], 0.4 * swings_rad[0]);
}

TEST(Pendulum, CannotBePutElsewhereNorPushed) {
  Trial trial(built(hanging()));
  BodyState state = trial.state();
  EXPECT_NO_THROW(trial.set_state(state));
  state.p_WB_m.x() += 0.01;
  EXPECT_THROW(trial.set_state(state), InvalidSituation);
  EXPECT_THROW(trial.joint_rad("hinge_4"), InvalidSituation);

  Situation pushed = hanging();
  pushed.motion = {"push", {}};
  EXPECT_THROW(simulate(built(pushed)), InvalidSituation);
  Situation rig = tumble_down(1.0, 100.0);
  rig.motion = {"swing", {}};
  EXPECT_THROW(simulate(built(rig)), InvalidSituation);
  Trial free(built(tumble_down(1.0, 100.0)));
  EXPECT_THROW(free.joint_rad("hinge_1"), InvalidSituation);
}

TEST(Reach, TurnsTheJointsToThePoseOrAsNearAsTheyLetIt) {
  const engine::World world = engine::compose(resolve(hanging()), models_folder());
  const engine::DataPtr there(mj_makeData(world.model.get())), data(mj_makeData(world.model.get()));
  const double angles_rad[5] = {0.05, -0.1, 0.7, -0.4, 1.1};
  ASSERT_EQ(world.model->nq, 5);
  std::copy(angles_rad, angles_rad + 5, there->qpos);
  engine::update_bodies(*world.model, *there);
  const BodyState state = engine::state_on_joints(*world.model, *there, world.robot_body);
  Isometry3d T_WB = Eigen::Isometry3d::Identity();
  T_WB.translation() = state.p_WB_m;
  T_WB.linear() = state.q_WB.toRotationMatrix();

  const auto position_m = [&] { return Vector3d(Eigen::Map<const Vector3d>(data->xpos + 3 * world.robot_body)); };
  engine::reach(world, T_WB, *data);
  EXPECT_NEAR((position_m() - state.p_WB_m).norm(), 0.0, 1e-4);
  T_WB.translation().x() += 50.0;  // out of reach: as near as possible with its attitude
  engine::reach(world, T_WB, *data);
  const Vector3d towards = position_m() - Vector3d(0, 0, kHeight_m);
  EXPECT_TRUE(towards.allFinite());
  EXPECT_LE(towards.norm(), 2.5 * kSegment_m + 1e-9);
  EXPECT_GT(towards.x(), kSegment_m);
}

}  // namespace
}  // namespace tumble::sim
