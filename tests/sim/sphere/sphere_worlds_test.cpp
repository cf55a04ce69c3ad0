// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_scene.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/sphere/free_sphere.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

Situation in_world(const std::string& type) {
  Situation situation = roll_along(1.0);
  situation.world.type = type;
  situation.world.values = {};
  return situation;
}

/// Returns the share of 2000 directions, evenly over the sphere, in which a ray from `from_m` hits something within 50
/// m.
double closed_share(const Situation& situation, const Vector3d& from_m) {
  const engine::World world = engine::compose(resolve(situation), models_folder());
  const RayScene scene(static_geometry(world, HeightFieldSides::open));
  constexpr int kRays = 2000;
  int hits = 0;
  for (int first = 0; first < kRays; first += kLanes) {
    RayPacket packet;
    for (int i = 0; i < kLanes; ++i) {
      const double z = 1.0 - 2.0 * (first + i + 0.5) / kRays, turn = 2.399963 * (first + i),
                   level = std::sqrt(1 - z * z);
      packet.origin_x[i] = static_cast<float>(from_m.x());
      packet.origin_y[i] = static_cast<float>(from_m.y());
      packet.origin_z[i] = static_cast<float>(from_m.z());
      packet.direction_x[i] = static_cast<float>(level * std::cos(turn));
      packet.direction_y[i] = static_cast<float>(level * std::sin(turn));
      packet.direction_z[i] = static_cast<float>(z);
      packet.range[i] = 50.0f;
      packet.surface_id[i] = kNothing;
    }
    scene.cast(packet);
    for (int i = 0; i < kLanes; ++i) hits += packet.surface_id[i] != kNothing ? 1 : 0;
  }
  return static_cast<double>(hits) / kRays;
}

TEST(SphereWorlds, AreClosedForALidar) {
  for (const char* type : {"corridor", "tube"}) {
    for (const double x_m : {-5.0, 0.0, 4.0})
      EXPECT_EQ(closed_share(in_world(type), {x_m, 0.1, 0.3}), 1.0) << type << " at " << x_m;
  }
  Situation room = in_world("floor");
  EXPECT_LT(closed_share(room, {0, 0, 0.3}), 0.9);  // negative control: the sky gives no return
  room.world.values.set("ceiling", 1.0);
  room.world.values.set("shelf_count", 8.0);
  EXPECT_EQ(closed_share(room, {0, 0, 0.3}), 1.0);
}

TEST(SphereWorlds, NothingTouchesTheVaultOfTheTube) {
  const engine::World world = engine::compose(resolve(in_world("tube")), models_folder());
  const int shell = mj_name2id(world.model.get(), mjOBJ_GEOM, "shell"),
            vault = mj_name2id(world.model.get(), mjOBJ_GEOM, "shell_left");
  ASSERT_GE(shell, 0);
  ASSERT_GE(vault, 0);
  EXPECT_EQ(world.model->geom_contype[shell] & world.model->geom_conaffinity[vault], 0);
  EXPECT_EQ(world.model->geom_contype[vault] & world.model->geom_conaffinity[shell], 0);
}

/// Returns the path of the contact point along the shell divided by the path of the centre, both from `from_s` on.
double rolled_share(const Truth& truth, const Vector3d& normal_W, double from_s) {
  double path_length_m = 0.0, rolled_m = 0.0;
  for (std::size_t k = static_cast<std::size_t>(from_s / 0.0005); k < truth.q_WB.size(); ++k) {
    const Vector3d w_W = truth.q_WB[k] * truth.w_WB_B_rad_s[k];
    path_length_m += truth.v_WB_m_s[k].norm();
    rolled_m += kRadius_m * w_W.cross(normal_W).norm();
  }
  return rolled_m / path_length_m;
}

Situation on_ramp(double friction) {
  Situation situation = in_world("ramp");
  situation.world.values.set("friction", friction);
  situation.world.values.set("spin_friction_m", 0.0);
  situation.world.values.set("slope_rad", 0.2);
  situation.world.values.set("ramp_x_m", -1.0);
  situation.world.values.set("ramp_length_m", 2.5);
  return situation;
}
const Vector3d kUp(-std::sin(0.2), 0.0, std::cos(0.2));

Truth released_on_ramp(FreeSphere& sphere) {
  const Vector3d at = Vector3d(1.2, 0.0, 2.2 * std::tan(0.2)) + kRadius_m * kUp;
  return sphere.launch(at, Vector3d::Zero(), Vector3d::Zero(), 0.8, false);
}

TEST(Ramp, AReleasedSphereRollsDownByTheLaw) {
  FreeSphere sphere(on_ramp(0.8));
  const Truth truth = released_on_ramp(sphere);
  EXPECT_NEAR(rolled_share(truth, kUp, 0.1), 1.0, 1e-3);
  // the acceleration a = g sin(slope) / (1 + I / (m r^2)) is measured between 0.2 and 0.7 s
  const double a_m_s2 = (truth.v_WB_m_s[1400] - truth.v_WB_m_s[400]).norm() / 0.5;
  EXPECT_NEAR(a_m_s2, kGravity_m_s2 * std::sin(0.2) / (1.0 + 1.0 / sphere.mass_ratio()), 0.002 * a_m_s2);
  EXPECT_EQ(count(truth, ContactLabel::slide) + count(truth, ContactLabel::slip), 0u);
}

TEST(Ramp, OnIceItSlidesDownInstead) {
  FreeSphere sphere(on_ramp(0.02));
  const Truth truth = released_on_ramp(sphere);
  EXPECT_LT(rolled_share(truth, kUp, 0.1), 0.6);
  EXPECT_GT(count(truth, ContactLabel::slide), truth.label.size() / 2);
}

// a height field consists of triangles: where they lie in one plane, the law of the plane must hold
TEST(Ground, AHeightFieldRollsAsAPlaneDoes) {
  Situation situation = level_floor(0.8);
  situation.world.values.set("roughness_m", 1e-9);
  FreeSphere sphere(situation);
  ASSERT_EQ(sphere.world().model->nhfield, 1);
  const Truth truth =
      sphere.launch({-0.61, 0.02, kRadius_m}, {1.0, 0.13, 0}, {-0.13 / kRadius_m, 1.0 / kRadius_m, 0}, 1.0);
  EXPECT_NEAR(rolled_share(truth, Vector3d::UnitZ(), 0.0), 1.0, 1e-3);
  EXPECT_EQ(count(truth, ContactLabel::grip), truth.label.size());
  // edges between triangles must not reduce the speed
  EXPECT_NEAR(truth.v_WB_m_s.back().norm(), truth.v_WB_m_s.front().norm(), 0.01 * truth.v_WB_m_s.front().norm());
}

TEST(Ground, RoughnessShakesAndLeavesTheGripAlone) {
  Situation situation = level_floor(0.8);
  situation.world.values.set("roughness_m", 0.003);
  FreeSphere sphere(situation);
  const Truth truth = sphere.launch({-0.6, 0, kRadius_m}, {0.6, 0, 0}, {0, 0.6 / kRadius_m, 0}, 1.0);
  double low_m = 1.0, high_m = 0.0;
  for (const Vector3d& p : truth.p_WB_m) {
    low_m = std::min(low_m, p.z());
    high_m = std::max(high_m, p.z());
  }
  EXPECT_GT(high_m - low_m, 0.002);
  EXPECT_LT(high_m - low_m, 0.03);
  EXPECT_LT(count(truth, ContactLabel::slip) + count(truth, ContactLabel::slide), truth.label.size() / 20);
}

double sink_m(double soft_time_s) {
  Situation situation = level_floor(0.5);
  situation.world.values.set("soft_time_s", soft_time_s);
  FreeSphere sphere(situation);
  const Truth truth = sphere.launch({0, 0, kRadius_m}, Vector3d::Zero(), Vector3d::Zero(), 0.01);
  return kRadius_m - truth.p_WB_m.back().z();
}

TEST(Ground, SoftGroundLetsTheSphereSink) {
  EXPECT_LT(sink_m(0.0), 5e-5);
  EXPECT_NEAR(sink_m(0.004), sink_m(0.0), 1e-6);  // as hard as the robot's own 4 ms
  // the stiffness is proportional to the inverse square of the time
  EXPECT_NEAR(sink_m(0.02) / sink_m(0.004), 25.0, 5.0);
}

TEST(Obstacles, AreAsHighAsTheySay) {
  for (const double kind : {1.0, 2.0, 3.0}) {
    Situation situation = level_floor(0.8);
    situation.world.values.set("obstacle_1_kind", kind);
    situation.world.values.set("obstacle_1_x_m", 0.5);
    situation.world.values.set("obstacle_1_height_m", 0.02);
    situation.world.values.set("obstacle_1_depth_m", 0.6);
    FreeSphere sphere(situation);
    // the sphere is fast enough to climb: v^2 > 2 g h
    const Truth truth = sphere.launch({0, 0, kRadius_m}, {1.2, 0, 0}, {0, 1.2 / kRadius_m, 0}, 1.0);
    double high_m = 0.0;
    for (const Vector3d& p : truth.p_WB_m) high_m = std::max(high_m, p.z());
    EXPECT_GT(high_m - kRadius_m, 0.019) << kind;
    EXPECT_GT(truth.p_WB_m.back().x(), 0.6) << kind;
  }
}

}  // namespace
}  // namespace tumble::sim
