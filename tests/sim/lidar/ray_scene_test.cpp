// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_scene.hpp"

#include "sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kReach_m = 1000.0;

struct Disagreement {
  int compared = 0, hits = 0, different_surface = 0, farther_than_1_mm = 0;
  std::array<int, mjNGEOMTYPES> hits_of_type{};
};

void set_ray(RayPacket& rays, int i, const Vector3d& origin, const Vector3d& direction, double range_m) {
  rays.origin_x[i] = static_cast<float>(origin.x());
  rays.origin_y[i] = static_cast<float>(origin.y());
  rays.origin_z[i] = static_cast<float>(origin.z());
  rays.direction_x[i] = static_cast<float>(direction.x());
  rays.direction_y[i] = static_cast<float>(direction.y());
  rays.direction_z[i] = static_cast<float>(direction.z());
  rays.range[i] = static_cast<float>(range_m);
  rays.surface_id[i] = kNothing;
}

/// Sets a ray of random direction whose origin is in the box from `low` to `high`.
void set_random(Stream& chance, RayPacket& rays, int i, const Vector3d& low, const Vector3d& high,
                double range_m = kReach_m) {
  const Vector3d direction = Vector3d(chance.normal(), chance.normal(), chance.normal()).normalized();
  Vector3d origin;
  for (int axis = 0; axis < 3; ++axis) origin[axis] = chance.uniform(low[axis], high[axis]);
  set_ray(rays, i, origin, direction, range_m);
}

/// The test casts random rays through the world, by this project's ray caster and by the engine. The surface comparison
/// omits grazing rays: for them a change of the origin within float resolution decides.
Disagreement compare_with_engine(const engine::World& world, const SceneGeometry& geometry, int packets) {
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  const RayScene scene(geometry);
  Stream chance(3, "test.rays");
  Disagreement out;
  for (int p = 0; p < packets; ++p) {
    RayPacket rays;
    for (int i = 0; i < kLanes; ++i) set_random(chance, rays, i, {-18, -18, -6}, {18, 18, 8});
    scene.cast(rays);
    for (int i = 0; i < kLanes; ++i) {
      const double origin[3] = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
      const double direction[3] = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
      int geom = -1;
      double expected = mj_ray(world.model.get(), data.get(), origin, direction, nullptr, 1, -1, &geom, nullptr);
      if (expected > kReach_m) expected = geom = -1;
      const int seen =
          rays.surface_id[i] == kNothing ? -1 : world.surface_geom[static_cast<std::size_t>(rays.surface_id[i])];
      ++out.compared;
      out.hits += expected >= 0.0;
      if (geom >= 0) ++out.hits_of_type[static_cast<std::size_t>(world.model->geom_type[geom])];
      out.different_surface += seen != geom;
      out.farther_than_1_mm += seen == geom && geom >= 0 && std::abs(rays.range[i] - expected) > 1e-3;
    }
  }
  return out;
}

TEST(RayScene, AgreesWithTheEngineOnAllGeomTypes) {
  const engine::World world = testing::rough_world(60, 60);
  const Disagreement d = compare_with_engine(world, static_geometry(world, HeightFieldSides::closed), 1250);
  EXPECT_EQ(d.compared, 20000);
  EXPECT_GT(d.hits, 8000);
  // measured: 0 and 0 of 20 000; the bound allows two rays that graze an edge
  EXPECT_LE(d.different_surface, 2);
  EXPECT_LE(d.farther_than_1_mm, 2);
}

/// EachGeomType tests each geom type alone and many times over, from all sides and from inside, above a plane without
/// edge; the types are all that a static world can have, except the signed-distance plugins, which are rejected.
class EachGeomType : public ::testing::TestWithParam<int> {};

engine::World crowd_of(int type) {
  static constexpr const char* kNames[] = {"plane",     "hfield",   "sphere", "capsule",
                                           "ellipsoid", "cylinder", "box",    "mesh"};
  const std::string name = kNames[type];
  Stream chance(21, "test.crowd");
  const auto number = [&](double low, double high) { return " " + std::to_string(chance.uniform(low, high)); };
  std::string mjcf =
      "<mujoco><asset><hfield name='h' nrow='9' ncol='14' size='3 2 1.5 0.3'/>"
      "<mesh name='m' vertex='0 0 0  2 0 0  0 2 0  2 2 0  0 0 1.5  0.4 1.7 1  1 1 -0.8'/></asset><worldbody>"
      "<geom name='floor' type='plane' size='0 0 1' pos='0 0 -5' euler='4 -3 0'/>";
  for (int i = 0; i < 40; ++i) {
    const std::string place = " pos='" + number(-15, 15) + number(-15, 15) + number(-4, 6) + "' euler='" +
                              number(-180, 180) + number(-180, 180) + number(-180, 180) + "'";
    const std::string shape = name == "hfield" ? " hfield='h'"
                              : name == "mesh"
                                  ? " mesh='m'"
                                  : " size='" + number(0.3, 2.0) + number(0.3, 2.0) + number(0.3, 2.0) + "'";
    mjcf += "<geom type='" + name + "'" + place + shape + "/>";
  }
  engine::World world = testing::world_of(mjcf + "</worldbody></mujoco>");
  for (int i = 0; i < world.model->nhfielddata; ++i) {
    world.model->hfield_data[i] = static_cast<float>(chance.uniform(0.0, 1.0));
  }
  return world;
}

TEST_P(EachGeomType, AgreesWithTheEngine) {
  const engine::World world = crowd_of(GetParam());
  const Disagreement d = compare_with_engine(world, static_geometry(world, HeightFieldSides::closed), 500);
  EXPECT_EQ(d.compared, 8000);
  EXPECT_GT(d.hits_of_type[static_cast<std::size_t>(GetParam())], 500);
  EXPECT_GT(d.hits_of_type[mjGEOM_PLANE], 500);  // the floor behind them
  // the bound allows one ray that grazes an edge
  EXPECT_LE(d.different_surface, 1);
  EXPECT_LE(d.farther_than_1_mm, 1);
}

INSTANTIATE_TEST_SUITE_P(, EachGeomType,
                         ::testing::Values(mjGEOM_PLANE, mjGEOM_HFIELD, mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_ELLIPSOID,
                                           mjGEOM_CYLINDER, mjGEOM_BOX, mjGEOM_MESH),
                         [](const auto& of) { return "type" + std::to_string(of.param); });

TEST(RayScene, NegativeControlWrongNamesAreFound) {
  const engine::World world = testing::rough_world(60, 60);
  SceneGeometry wrong = static_geometry(world, HeightFieldSides::closed);
  for (SceneShape& part : wrong.shapes) part.surface_id = (part.surface_id + 1) % 60;
  const Disagreement d = compare_with_engine(world, wrong, 250);
  EXPECT_GT(d.different_surface, 500);
}

TEST(RayScene, NegativeControlGeometryShiftedByOneCentimetreIsFound) {
  const engine::World world = testing::rough_world(60, 60);
  SceneGeometry shifted = static_geometry(world, HeightFieldSides::closed);
  for (SceneShape& part : shifted.shapes) part.shape.p_FS_m.z() += 0.01;
  for (SceneMesh& part : shifted.meshes) {
    for (Vector3f& v : part.mesh.vertices_F_m) v.z() += 0.01f;
  }
  const Disagreement d = compare_with_engine(world, shifted, 250);
  EXPECT_GT(d.farther_than_1_mm, d.hits / 2);
}

TEST(RayScene, NegativeControlTheOtherDiagonalIsFound) {
  const engine::World world = testing::rough_world(60, 0);
  SceneGeometry wrong = static_geometry(world, HeightFieldSides::closed);
  auto& triangles = wrong.meshes.at(0).mesh.triangles;
  for (std::size_t i = 0; i + 1 < 2 * 60 * 60; i += 2) {
    const auto [here, right, across] = triangles[i];
    const std::uint32_t up = triangles[i + 1][2];
    triangles[i] = {here, right, up};
    triangles[i + 1] = {right, across, up};
  }
  EXPECT_GT(compare_with_engine(world, wrong, 250).farther_than_1_mm, 500);
}

TEST(RayScene, VisualGeomsAreTransparent) {
  const engine::World world = testing::world_of(
      "<mujoco><worldbody><geom type='sphere' size='1' pos='5 0 0' contype='0' conaffinity='0'/>"
      "<geom type='sphere' size='1' pos='9 0 0'/></worldbody></mujoco>");
  const RayScene scene(static_geometry(world, HeightFieldSides::closed));
  RayPacket rays;
  rays.count = 1;
  set_ray(rays, 0, Vector3d::Zero(), Vector3d::UnitX(), 100.0);
  scene.cast(rays);
  EXPECT_EQ(rays.surface_id[0], 1);
  EXPECT_FLOAT_EQ(rays.range[0], 8.0f);
  EXPECT_FLOAT_EQ(rays.cosine[0], 1.0f);
}

// the content of unused lanes, and which rays share a packet, change no bit: a kernel that depended on either would
// give other recordings on other CPUs
TEST(RayScene, ALaneIsAloneAndUnusedOnesMayHoldAnything) {
  const engine::World world = testing::rough_world(60, 60);
  const RayScene scene(static_geometry(world, HeightFieldSides::closed));
  Stream chance(5, "test.lanes");
  int hits = 0;
  for (int p = 0; p < 200; ++p) {
    RayPacket together;
    for (int i = 0; i < kLanes; ++i) set_random(chance, together, i, {-18, -18, -6}, {18, 18, 8});
    const RayPacket given = together;
    scene.cast(together);
    for (int i = 0; i < kLanes; ++i) {
      RayPacket alone;
      const float odd[] = {std::nanf(""), std::numeric_limits<float>::infinity(), -1e38f, 0.0f};
      for (int k = 0; k < kLanes; ++k) {
        alone.origin_x[k] = alone.origin_y[k] = alone.origin_z[k] = alone.direction_x[k] = alone.direction_y[k] =
            alone.direction_z[k] = alone.range[k] = odd[(k + p) % 4];
      }
      alone.count = 1;
      alone.origin_x[0] = given.origin_x[i], alone.origin_y[0] = given.origin_y[i],
      alone.origin_z[0] = given.origin_z[i];
      alone.direction_x[0] = given.direction_x[i], alone.direction_y[0] = given.direction_y[i];
      alone.direction_z[0] = given.direction_z[i], alone.range[0] = given.range[i];
      alone.surface_id[0] = kNothing;
      scene.cast(alone);
      ASSERT_EQ(alone.surface_id[0], together.surface_id[i]);
      ASSERT_EQ(alone.range[0], together.range[i]);
      if (alone.surface_id[0] == kNothing) continue;
      ++hits;
      ASSERT_EQ(alone.cosine[0], together.cosine[i]);
    }
  }
  EXPECT_GT(hits, 1000);
}

/// The test uses closed forms: an unbounded plane at an angle, a sphere away from the axis, a box face.
TEST(RayScene, AnalyticPlaneSphereBox) {
  SceneGeometry geometry;
  Shape plane{ShapeKind::plane, Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0.0, 0.0, -2.0}};
  Shape sphere{ShapeKind::sphere, {1.5, 0, 0}, Eigen::Matrix3d::Identity(), {0.0, 10.0, 0.5}};
  Shape box{
      ShapeKind::box, {1.0, 2.0, 3.0}, Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix(), {-8.0, 0.0, 0.0}};
  geometry.shapes = {{plane, 0, 0.1f}, {sphere, 1, 0.2f}, {box, 2, 0.3f}};
  const RayScene scene(geometry);
  RayPacket rays;
  rays.count = 3;
  const Vector3d directions[3] = {Vector3d(1.0, 0.5, -0.5).normalized(), Vector3d::UnitY(), -Vector3d::UnitX()};
  for (int i = 0; i < 3; ++i) set_ray(rays, i, Vector3d::Zero(), directions[i], kReach_m);
  scene.cast(rays);
  const double half_chord = std::sqrt(1.5 * 1.5 - 0.5 * 0.5);
  const double expected[3] = {2.0 / -directions[0].z(), 10.0 - half_chord, 8.0 - 1.0 / std::cos(0.5)};
  const double cosine[3] = {-directions[0].z(), half_chord / 1.5, std::cos(0.5)};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(rays.surface_id[i], i);
    // a float at 10 m resolves 1e-6 m
    EXPECT_NEAR(rays.range[i], expected[i], 2e-6);
    EXPECT_NEAR(rays.cosine[i], cosine[i], 1e-6);
    EXPECT_FLOAT_EQ(rays.reflectivity[i], 0.1f * static_cast<float>(i + 1));
  }
}

/// The test compares every primitive with its implicit surface: a hit lies on it, no part of the surface lies before
/// the hit, and a missed ray never crosses it.
TEST(RayScene, AnalyticPrimitivesHoldTheirEquation) {
  Stream chance(31, "test.primitives");
  for (const ShapeKind kind :
       {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::ellipsoid, ShapeKind::cylinder, ShapeKind::box}) {
    SceneGeometry geometry;
    const Shape shape{kind,
                      {0.7, 1.1, 0.4},
                      Eigen::AngleAxisd(0.8, Vector3d(3, 1, 2).normalized()).toRotationMatrix(),
                      {0.5, -0.3, 0.2}};
    geometry.shapes = {{shape, 7, 0.4f}};
    const RayScene scene(geometry);
    int hits = 0;
    double worst_m = 0.0;
    for (int p = 0; p < 100; ++p) {
      RayPacket rays;
      for (int i = 0; i < kLanes; ++i) set_random(chance, rays, i, {-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, 10.0);
      scene.cast(rays);
      for (int i = 0; i < kLanes; ++i) {
        const Vector3d origin(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]);
        const Vector3d direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
        const double range = rays.range[i];
        if (rays.surface_id[i] == 7) {
          ++hits;
          worst_m = std::max(worst_m, surface_distance(shape, origin + range * direction));
        }
        const bool inside = contains(shape, origin);
        for (double x = 0.0; x < range - 1e-4; x += 0.02) {
          ASSERT_EQ(contains(shape, origin + x * direction), inside) << "kind " << static_cast<int>(kind);
        }
      }
    }
    EXPECT_GT(hits, 150) << "kind " << static_cast<int>(kind);
    // the tolerance covers float ranges of up to 5 m, at grazing incidence too; measured 3e-7 m
    EXPECT_LT(worst_m, 2e-6) << "kind " << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace tumble::sim
