// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/shape_lanes.hpp"

#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

struct EightRays {
  std::array<std::array<float, kShapeLanes>, 6> coordinate;

  ShapeRays view() const {
    return {coordinate[0].data(), coordinate[1].data(), coordinate[2].data(),
            coordinate[3].data(), coordinate[4].data(), coordinate[5].data()};
  }
  Vector3d origin_m(int i) const { return vector(0, i); }
  Vector3d direction(int i) const { return vector(3, i); }

 private:
  Vector3d vector(std::size_t first, int i) const {
    const auto at = static_cast<std::size_t>(i);
    return {coordinate[first][at], coordinate[first + 1][at], coordinate[first + 2][at]};
  }
};

Vector3d normals(Stream& chance) {
  return {chance.normal(), chance.normal(), chance.normal()};
}

/// Returns rays of which some are along the axes of the world, where they run along the sides of an has_unknown_rate
/// box.
EightRays random_rays(Stream& chance) {
  EightRays rays;
  for (std::size_t i = 0; i < kShapeLanes; ++i) {
    Vector3d direction = normals(chance);
    if (i < 3) direction[static_cast<int>(i)] = 0.0;
    if (i == 3) direction = Vector3d::UnitX();
    direction.normalize();
    for (std::size_t k = 0; k < 3; ++k) {
      rays.coordinate[k][i] = static_cast<float>(2.0 * chance.normal());
      rays.coordinate[k + 3][i] = static_cast<float>(direction[static_cast<int>(k)]);
    }
  }
  return rays;
}

Shape random_shape(Stream& chance, ShapeKind kind, int number) {
  Shape shape;
  shape.kind = kind;
  shape.size_m = Vector3d(chance.uniform(0.1, 3.0), chance.uniform(0.1, 3.0), chance.uniform(0.1, 3.0));
  if (kind == ShapeKind::plane && number % 3 == 0) shape.size_m.x() = 0.0;  // unbounded
  shape.p_FS_m = normals(chance);
  const Vector3d axis = normals(chance).normalized();
  if (number % 4 != 0) shape.R_FS = Eigen::AngleAxisd(chance.uniform(0.0, 3.0), axis).toRotationMatrix();
  return shape;
}

class ShapeLanes : public ::testing::TestWithParam<ShapeKind> {};

/// The comparison is exact, because a draw's digest depends on these bits.
TEST_P(ShapeLanes, AreCastRayOfEach) {
  Stream chance(7, "test.shape_lanes");
  int met = 0;
  for (int n = 0; n < 4000; ++n) {
    const Shape shape = random_shape(chance, GetParam(), n);
    const EightRays rays = random_rays(chance);
    const std::array<int, kShapeLanes> wanted = {-1, -1, -1, -1, -1, -1, -1, -1};
    ShapeHits hits;
    cast_rays(shape, rays.view(), wanted.data(), hits);
    for (int i = 0; i < kShapeLanes; ++i) {
      Vector3d normal;
      const double range_m = cast_ray(shape, rays.origin_m(i), rays.direction(i), normal);
      ASSERT_EQ(hits.range_m[i], range_m) << "shape " << n << ", ray " << i;
      if (!std::isfinite(range_m)) continue;
      ++met;
      ASSERT_EQ(Vector3d(hits.normal_x[i], hits.normal_y[i], hits.normal_z[i]), normal)
          << "shape " << n << ", ray " << i;
    }
  }
  EXPECT_GT(met, 1000);  // of 32 000; a plane is hit only from its front
}

INSTANTIATE_TEST_SUITE_P(, ShapeLanes,
                         ::testing::Values(ShapeKind::plane, ShapeKind::box, ShapeKind::capsule, ShapeKind::cylinder),
                         [](const auto& of) { return "kind" + std::to_string(static_cast<int>(of.param)); });

TEST(ShapeLanesUnwanted, AreLeftOut) {
  Stream chance(8, "test.shape_lanes");
  const Shape ball = random_shape(chance, ShapeKind::sphere, 0);
  const EightRays rays = random_rays(chance);
  const std::array<int, kShapeLanes> none{};
  ShapeHits hits;
  for (double& range_m : hits.range_m) range_m = -5.0;
  cast_rays(ball, rays.view(), none.data(), hits);
  for (const double range_m : hits.range_m) EXPECT_EQ(range_m, -5.0);
}

}  // namespace
}  // namespace tumble::sim
