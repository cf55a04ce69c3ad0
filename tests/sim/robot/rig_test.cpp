// SPDX-License-Identifier: BSD-3-Clause
#include "sim/compose.hpp"
#include "sim/engine/model.hpp"
#include "sim/motion/rigid_body.hpp"
#include "sim/robot/robot_type.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

engine::World rig(const Values& values) {
  Situation situation = tumble_down(1.0, 100.0);
  situation.robot.values = values;
  return engine::compose(resolve(situation), models_folder());
}

double contact_time_s(const engine::World& world, const std::string& strut) {
  const int geom = mj_name2id(world.model.get(), mjOBJ_GEOM, strut.c_str());
  EXPECT_GE(geom, 0) << strut;
  return geom < 0 ? 0.0 : world.model->geom_solref[mjNREF * geom];
}

TEST(Rig, EachStrutHasItsOwnSoftness) {
  Values values;
  values.set("contact_time_s", 0.04);
  values.set("lower_contact_ratio", 0.5);
  values.set("upper_contact_ratio", 1.5);
  values.set("upright_contact_ratio", 2.0);
  const engine::World world = rig(values);
  for (const char* side : {"front", "back", "left", "right"}) {
    EXPECT_NEAR(contact_time_s(world, std::string("strut_lower_") + side), 0.02, 1e-12);
    EXPECT_NEAR(contact_time_s(world, std::string("strut_upper_") + side), 0.06, 1e-12);
  }
  for (const char* corner : {"front_left", "front_right", "back_left", "back_right"})
    EXPECT_NEAR(contact_time_s(world, std::string("strut_") + corner), 0.08, 1e-12);
}

TEST(Rig, CageKeepsWithinThePublishedCropBox) {
  const engine::World world = rig({});
  const int lidar = mj_name2id(world.model.get(), mjOBJ_SITE, "rs16");
  ASSERT_GE(lidar, 0);
  const Vector3d p_BL_m = Eigen::Map<const Vector3d>(world.model->site_pos + 3 * lidar);
  int struts = 0;
  for (int g = 0; g < world.model->ngeom; ++g) {
    if (world.model->geom_type[g] != mjGEOM_CAPSULE) continue;
    ++struts;
    const Eigen::Map<const Vector3d> p(world.model->geom_pos + 3 * g);
    const mjtNum* q = world.model->geom_quat + 4 * g;
    const Vector3d axis = Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitZ();
    const double half_m = world.model->geom_size[3 * g + 1], radius_m = world.model->geom_size[3 * g];
    for (const double end : {-1.0, 1.0}) {
      const Vector3d tip = p + end * half_m * axis - p_BL_m;
      EXPECT_LE(std::abs(tip.x()) + radius_m, 0.4);
      EXPECT_LE(std::abs(tip.y()) + radius_m, 0.4);
      EXPECT_GE(tip.z() - radius_m, -0.27);
      EXPECT_LE(tip.z() + radius_m, 0.2);
    }
  }
  EXPECT_EQ(struts, 12);
}

TEST(Rig, PrincipalAxesTurnWithTheCage) {
  Values values;
  values.set("inertia_x_kg_m2", 0.2);
  values.set("inertia_ratio_y", 1.5);
  values.set("inertia_ratio_z", 1.7);
  values.set("inertia_yaw_rad", 0.5);
  const engine::World world = rig(values);
  const Matrix3d J = inertia_W_kg_m2(*world.model, world.robot_body, Eigen::Quaterniond::Identity());
  const Vector3d first(std::cos(0.5), std::sin(0.5), 0.0), second(-std::sin(0.5), std::cos(0.5), 0.0);
  EXPECT_NEAR((J * first - 0.2 * first).norm(), 0.0, 1e-9);
  EXPECT_NEAR((J * second - 0.3 * second).norm(), 0.0, 1e-9);
  EXPECT_NEAR(J(2, 2), 0.34, 1e-9);
}

}  // namespace
}  // namespace tumble::sim
