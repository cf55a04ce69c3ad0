// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/near_geoms.hpp"

#include "sim/lidar/test_worlds.hpp"
#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::sim::engine {
namespace {

/// Returns a cage of three struts among many rocks on a height field or, without one, on a plane.
World crowd(bool with_field) {
  Stream chance(31, "test.near");
  const auto number = [&](double low, double high) { return " " + std::to_string(chance.uniform(low, high)); };
  std::string mjcf = "<mujoco><asset><hfield name='h' nrow='9' ncol='9' size='8 8 1.5 0.3'/></asset><worldbody>";
  mjcf += with_field ? "<geom type='hfield' hfield='h'/>" : "<geom type='plane' size='0 0 1'/>";
  static constexpr const char* kKinds[] = {"sphere", "box", "capsule"};
  for (int i = 0; i < 90; ++i) {
    mjcf += std::string("<geom type='") + kKinds[i % 3] + "' pos='" + number(-8, 8) + number(-8, 8) + number(0, 2) +
            "' euler='" + number(-180, 180) + number(-180, 180) + number(-180, 180) + "' size='" + number(0.1, 0.6) +
            number(0.1, 0.6) + number(0.1, 0.6) + "'/>";
  }
  mjcf +=
      "<body name='robot' pos='0 0 3'><freejoint/><geom type='capsule' fromto='-0.4 0 0 0.4 0.1 0' size='0.03'/>"
      "<geom type='capsule' fromto='0 -0.4 0.1 0 0.4 0' size='0.03'/>"
      "<geom type='capsule' fromto='0 0 -0.4 0.1 0 0.4' size='0.03'/></body></worldbody></mujoco>";
  World world = testing::world_of(mjcf);
  for (int i = 0; i < world.model->nhfielddata; ++i)
    world.model->hfield_data[i] = static_cast<float>(chance.uniform(0.0, 1.0));
  return world;
}

/// Returns distances and geoms of all contacts, in their order, with the robot at a position.
std::vector<double> contacts_at(const mjModel& model, mjData& data, const Vector3d& p_m, const Quaterniond& q) {
  Vector3d::Map(data.qpos) = p_m;
  data.qpos[3] = q.w();
  for (int i = 0; i < 3; ++i) data.qpos[4 + i] = q.vec()[i];
  mj_fwdPosition(&model, &data);
  std::vector<double> all;
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    all.insert(all.end(), {double(contact.geom[0]), double(contact.geom[1]), contact.dist, contact.pos[0],
                           contact.pos[1], contact.pos[2], contact.frame[0], contact.frame[1], contact.frame[2]});
  }
  return all;
}

struct Comparison {
  int with_contacts = 0, different = 0;
};

/// Moves the robot in steps of some centimetres with occasional leaps, and compares its contacts with the compiler's
/// tree.
Comparison walk(bool with_field, bool told) {
  const World near = crowd(with_field), all = crowd(with_field);
  const DataPtr near_data(mj_makeData(near.model.get())), all_data(mj_makeData(all.model.get()));
  NearGeoms geoms(*near.model);
  Stream chance(32, "test.near");
  Vector3d p_m(0.0, 0.0, 1.0);
  geoms.around(p_m);
  Comparison out;
  for (int k = 0; k < 3000; ++k) {
    const double reach_m = k % 100 == 0 ? 5.0 : 0.05;
    p_m += reach_m * Vector3d(chance.normal(), chance.normal(), 0.3 * chance.normal());
    p_m = p_m.cwiseMin(Vector3d(8.0, 8.0, 1.5)).cwiseMax(Vector3d(-8.0, -8.0, 0.0));
    const Quaterniond q = Quaterniond(chance.normal(), chance.normal(), chance.normal(), chance.normal()).normalized();
    if (told) geoms.around(p_m);
    const std::vector<double> expected = contacts_at(*all.model, *all_data, p_m, q);
    out.with_contacts += !expected.empty();
    out.different += contacts_at(*near.model, *near_data, p_m, q) != expected;
  }
  return out;
}

TEST(NearGeoms, LeaveEveryContactInItsOrder) {
  for (const bool with_field : {true, false}) {
    const Comparison told = walk(with_field, true);
    EXPECT_GT(told.with_contacts, 500);
    EXPECT_EQ(told.different, 0);
  }
}

TEST(NearGeoms, NegativeControlOfAnotherPlaceLoseSome) {
  EXPECT_GT(walk(false, false).different, 50);
}

TEST(NearGeoms, GiveTheTreeBack) {
  const World world = crowd(true);
  const mjModel& model = *world.model;
  const auto tree = [&] {
    std::vector<double> all(model.bvh_aabb, model.bvh_aabb + 6 * model.nbvhstatic);
    all.insert(all.end(), model.bvh_child, model.bvh_child + 2 * model.nbvh);
    all.insert(all.end(), model.bvh_nodeid, model.bvh_nodeid + model.nbvh);
    return all;
  };
  const std::vector<double> before = tree();
  {
    NearGeoms geoms(*world.model);
    EXPECT_EQ(tree(), before);
    geoms.around(Vector3d::Zero());
    EXPECT_NE(tree(), before);
  }
  EXPECT_EQ(tree(), before);
}

TEST(NearGeoms, LeaveAWorldWithJointsAlone) {
  const World world = testing::world_of(
      "<mujoco><worldbody><geom type='plane' size='0 0 1'/><geom type='box' size='1 1 1' pos='9 0 0'/>"
      "<body name='robot' pos='0 0 3'><joint type='hinge'/><geom type='sphere' "
      "size='0.1'/></body></worldbody></mujoco>");
  EXPECT_FALSE(NearGeoms::serves(*world.model));
  NearGeoms geoms(*world.model);
  const std::vector<double> before(world.model->bvh_aabb, world.model->bvh_aabb + 6 * world.model->nbvhstatic);
  geoms.around(Vector3d(50.0, 0.0, 0.0));
  EXPECT_EQ(std::vector<double>(world.model->bvh_aabb, world.model->bvh_aabb + 6 * world.model->nbvhstatic), before);
}

}  // namespace
}  // namespace tumble::sim::engine
