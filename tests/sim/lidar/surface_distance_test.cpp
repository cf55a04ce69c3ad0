// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_scene.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "sim/lidar/triangle.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns points on the whole surface of a shape, from rays cast at it from far away in every direction and from its
/// centre.
std::vector<Vector3d> surface_samples(const Shape& shape, int count) {
  Stream chance(5, "test.samples");
  std::vector<Vector3d> out;
  while (static_cast<int>(out.size()) < count) {
    const Vector3d direction = Vector3d(chance.normal(), chance.normal(), chance.normal()).normalized();
    const Vector3d inside =
        shape.p_FS_m + shape.R_FS * Vector3d(0.0, 0.0, chance.uniform(-1, 1) * half_extent(shape).z());
    Vector3d normal;
    const double range = cast_ray(shape, inside, direction, normal);
    if (std::isfinite(range)) out.push_back(inside + range * direction);
  }
  return out;
}

/// No sample of the surface is nearer than the distance, and the nearest of many samples comes close to it.
TEST(SurfaceDistance, PrimitivesAgainstDenseSamples) {
  Stream chance(8, "test.shapes");
  for (const ShapeKind kind :
       {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::ellipsoid, ShapeKind::cylinder, ShapeKind::box}) {
    Shape shape;
    shape.kind = kind;
    shape.size_m = Vector3d(0.5, 0.9, 0.3);
    shape.p_FS_m = Vector3d(1.0, -2.0, 3.0);
    shape.R_FS = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const std::vector<Vector3d> samples = surface_samples(shape, 40000);
    for (int i = 0; i < 40; ++i) {
      const Vector3d point = shape.p_FS_m + 0.8 * Vector3d(chance.normal(), chance.normal(), chance.normal());
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vector3d& s : samples) nearest = std::min(nearest, (s - point).norm());
      const double distance = surface_distance(shape, point);
      EXPECT_LE(distance, nearest + 1e-9) << "kind " << static_cast<int>(kind);
      // 40 000 samples on about 4 m^2 lie 1 cm apart, and farther apart near edges: the nearest sample differs by up to
      // 3 cm
      EXPECT_GE(distance, nearest - 0.03) << "kind " << static_cast<int>(kind);
    }
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(surface_distance(shape, samples[static_cast<std::size_t>(i)]), 0.0, 1e-7);
  }
}

TEST(SurfaceDistance, EllipsoidOnItsSymmetryPlanes) {
  const Shape shape{ShapeKind::ellipsoid, Vector3d(1.0, 2.0, 3.0), Eigen::Matrix3d::Identity(), Vector3d::Zero()};
  EXPECT_NEAR(surface_distance(shape, Vector3d::Zero()), 1.0, 1e-9);
  EXPECT_NEAR(surface_distance(shape, Vector3d(0.0, 5.0, 0.0)), 3.0, 1e-9);
  EXPECT_NEAR(surface_distance(shape, Vector3d(0.25, 0.0, 0.0)), 0.75, 1e-9);
  // on the long axis inside the evolute, the nearest point does not lie on the axis: z = 9 * 0.5 / 8, x = sqrt(1 - z^2
  // / 9)
  const double z = 9.0 * 0.5 / 8.0, x = std::sqrt(1.0 - z * z / 9.0);
  EXPECT_NEAR(surface_distance(shape, Vector3d(0.0, 0.0, 0.5)), std::hypot(x, z - 0.5), 1e-9);
}

/// The test compares the hierarchy with a loop over every triangle and shape.
TEST(SurfaceDistance, SceneAgainstBruteForce) {
  const engine::World world = testing::rough_world(40, 30);
  const SceneGeometry geometry = static_geometry(world, HeightFieldSides::open);
  const RayScene scene(geometry);
  Stream chance(9, "test.points");
  int within = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3f point(static_cast<float>(chance.uniform(-22, 22)), static_cast<float>(chance.uniform(-22, 22)),
                         static_cast<float>(chance.uniform(-3, 5)));
    const float limit = 1.5f;
    float nearest = limit;
    for (const SceneShape& s : geometry.shapes) {
      nearest = std::min(nearest, static_cast<float>(surface_distance(s.shape, point.cast<double>())));
    }
    for (const SceneMesh& m : geometry.meshes) {
      const auto& v = m.mesh.vertices_F_m;
      for (const auto& t : m.mesh.triangles)
        nearest = std::min(nearest, triangle_distance(v[t[0]], v[t[1]], v[t[2]], point));
    }
    within += nearest < limit;
    EXPECT_FLOAT_EQ(scene.distance(point, limit), nearest);
  }
  EXPECT_GT(within, 100);
}

/// The closed base of a height field serves only rays: a point under the ground must not be "near" the field's
/// underside.
TEST(SurfaceDistance, TheUndersideIsNoSurface) {
  const engine::World world = testing::world_of(
      "<mujoco><asset><hfield name='h' nrow='3' ncol='3' size='5 5 1 0.5'/></asset>"
      "<worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>");
  const RayScene open(static_geometry(world, HeightFieldSides::open));
  const RayScene closed(static_geometry(world, HeightFieldSides::closed));
  EXPECT_NEAR(open.distance({0.1f, 0.2f, -0.45f}, 2.0f), 0.45f, 1e-6f);
  EXPECT_NEAR(closed.distance({0.1f, 0.2f, -0.45f}, 2.0f), 0.05f, 1e-6f);
}

}  // namespace
}  // namespace tumble::sim
