// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/world_mesh.hpp"

#include "sim/lidar/surface.hpp"
#include "sim/render/tessellation.hpp"
#include "tests/sim/render/built_world.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns the volume enclosed by the triangles, which is positive when they turn to the left seen from outside
/// (divergence theorem).
double volume(const Tessellation& mesh) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices_F_m[triangle[0]].cast<double>(), b = mesh.vertices_F_m[triangle[1]].cast<double>(),
                   c = mesh.vertices_F_m[triangle[2]].cast<double>();
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

Shape shape_of(ShapeKind kind, const Vector3d& size_m) {
  Shape shape;
  shape.kind = kind;
  shape.size_m = size_m;
  shape.R_FS = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  shape.p_FS_m = Vector3d(0.3, -0.2, 0.5);
  return shape;
}

TEST(Tessellation, EnclosesTheVolumeOfThePrimitive) {
  const double pi = std::numbers::pi, r = 0.4, h = 0.7;
  const std::pair<Shape, double> cases[] = {
      {shape_of(ShapeKind::box, {0.2, 0.3, 0.5}), 8 * 0.2 * 0.3 * 0.5},
      {shape_of(ShapeKind::sphere, {r, 0, 0}), 4.0 / 3.0 * pi * r * r * r},
      {shape_of(ShapeKind::ellipsoid, {0.2, 0.3, 0.5}), 4.0 / 3.0 * pi * 0.2 * 0.3 * 0.5},
      {shape_of(ShapeKind::cylinder, {r, h, 0}), 2 * pi * r * r * h},
      {shape_of(ShapeKind::capsule, {r, h, 0}), 2 * pi * r * r * h + 4.0 / 3.0 * pi * r * r * r}};
  for (const auto& [shape, expected] : cases) {
    const Tessellation fine = tessellate(shape, 128, 1.0), coarse = tessellate(shape, 8, 1.0);
    // an inscribed polygon of n corners has 1 - 2/3 (pi / n)^2 of the circle's area; a ball loses twice this share
    EXPECT_NEAR(volume(fine), expected, 1.5e-3 * expected) << static_cast<int>(shape.kind);
    EXPECT_GT(volume(coarse), 0.6 * expected) << static_cast<int>(shape.kind);
    EXPECT_LE(volume(coarse), (1.0 + 1e-6) * expected) << "inscribed";
    // negative control: the test detects one triangle of the wrong orientation
    Tessellation wrong = fine;
    for (auto& triangle : wrong.triangles) std::swap(triangle[0], triangle[1]);
    EXPECT_LT(volume(wrong), 0.0);
  }
}

TEST(Tessellation, VerticesLieOnTheSurface) {
  for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::ellipsoid, ShapeKind::cylinder,
                               ShapeKind::box, ShapeKind::plane}) {
    const Shape shape = shape_of(kind, {0.4, 0.3, 0.2});
    const Tessellation mesh = tessellate(shape, 12, 5.0);
    ASSERT_GE(mesh.vertices_F_m.size(), 4u);
    for (const Vector3f& vertex : mesh.vertices_F_m) {
      EXPECT_NEAR(surface_distance(shape, vertex.cast<double>()), 0.0, 1e-6) << static_cast<int>(kind);
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.vertices_F_m.size());
    }
  }
}

TEST(WorldMesh, LiesOnTheSurfaceThatMapsAreScoredBy) {
  const BuiltSituation hill = built_world("hill", "rig");
  const Surface surface(hill);
  const std::vector<MeshPart> parts = world_mesh(hill);
  ASSERT_GT(parts.size(), 20u) << "rocks and trunks";
  const auto field = std::find_if(parts.begin(), parts.end(), [](const MeshPart& part) { return part.rows > 0; });
  ASSERT_NE(field, parts.end());
  ASSERT_EQ(field->vertices_m.size(), static_cast<std::size_t>(field->rows * field->columns));
  EXPECT_LT(field->vertices_m[0].x(), field->vertices_m[1].x()) << "x grows along a row";
  EXPECT_LT(field->vertices_m[0].y(), field->vertices_m[static_cast<std::size_t>(field->columns)].y());
  for (const MeshPart& part : parts) {
    const std::vector<float> distances = surface.distances(part.vertices_m, 1.0f);
    EXPECT_LT(*std::max_element(distances.begin(), distances.end()), 1e-3f);
  }
  // negative control: the test detects a field that was moved by a hand's breadth
  std::vector<Vector3f> moved = field->vertices_m;
  for (Vector3f& vertex : moved) vertex.z() += 0.1f;
  const std::vector<float> off = surface.distances(moved, 1.0f);
  EXPECT_GT(*std::max_element(off.begin(), off.end()), 0.05f);
}

TEST(WorldMesh, OfAPlaneIsAFieldOfOneCellThatLooksUp) {
  const std::vector<MeshPart> parts = world_mesh(built_world("floor", "sphere"));
  const auto floor = std::find_if(parts.begin(), parts.end(), [](const MeshPart& part) { return part.rows == 2; });
  ASSERT_NE(floor, parts.end());
  ASSERT_EQ(floor->vertices_m.size(), 4u);
  const auto& v = floor->vertices_m;  // corners of the first triangle of a cell: this one, the next, and the one above
  EXPECT_GT((v[1] - v[0]).cross(v[3] - v[0]).z(), 0.0f);
}

TEST(RobotMesh, HasTheRobotsSize) {
  double farthest = 0.0;
  for (const MeshPart& part : robot_mesh(built_world("hill", "rig"))) {
    for (const Vector3f& vertex : part.vertices_m) farthest = std::max<double>(farthest, vertex.norm());
  }
  // models/rig.xml gives the corner of the cage plus half its tube
  const double corner = Vector3d(0.3095, 0.0261, 0.185).norm();
  EXPECT_GT(farthest, corner - 0.03);
  EXPECT_LT(farthest, corner + 0.06);
  const std::vector<MeshPart> sphere = robot_mesh(built_world("floor", "sphere"));
  ASSERT_FALSE(sphere.empty());
  EXPECT_TRUE(std::any_of(sphere.begin(), sphere.end(), [](const MeshPart& p) { return p.rgba[3] < 1.0f; })) << "shell";
}

}  // namespace
}  // namespace tumble::sim
