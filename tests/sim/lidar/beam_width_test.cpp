// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/casting.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

using testing::Cast;
using testing::cast;
using testing::resting;

constexpr int kRays = 16;
constexpr double kHalfAngle_rad = 5e-3;

/// Returns a lidar with one beam along x, ten milliradians wide.
SensorSpec wide_beam(double echo_length_m) {
  SensorSpec sensor = testing::exact_lidar_of("rosette_lidar");
  for (const char* name : {"prism_1_amplitude", "prism_2_amplitude", "mixed_amplitude"}) sensor.values.set(name, 0.0);
  sensor.values.set("units", 1.0);
  sensor.values.set("beam_rays", kRays);
  sensor.values.set("divergence_horizontal_rad", 2.0 * kHalfAngle_rad);
  sensor.values.set("divergence_vertical_rad", 2.0 * kHalfAngle_rad);
  sensor.values.set("echo_length_m", echo_length_m);
  return sensor;
}

std::string wall(double from_y, double to_y, double at_x, double grey) {
  const std::string tone = std::to_string(grey);
  return "<geom type='box' size='0.05 " + std::to_string(0.5 * (to_y - from_y)) + " 9' pos='" +
         std::to_string(at_x + 0.05) + " " + std::to_string(0.5 * (from_y + to_y)) + " 0' rgba='" + tone + " " + tone +
         " " + tone + " 1'/>";
}

Cast cast_at(const std::string& walls, double echo_length_m) {
  return cast(testing::world_of("<mujoco><worldbody>" + walls + "</worldbody></mujoco>"), wide_beam(echo_length_m),
              resting(0.1));
}

/// The tangents of the rays are computed a second way: equal shares of the ellipse by the golden angle.
Vector3d ray(int k) {
  const double radius = std::sqrt((k + 0.5) / kRays), angle = k * M_PI * (3.0 - std::sqrt(5.0));
  return {1.0, radius * std::cos(angle) * std::tan(kHalfAngle_rad),
          radius * std::sin(angle) * std::tan(kHalfAngle_rad)};
}

struct Mixed {
  double energy = 0.0, moment = 0.0;
  int rays = 0;
  void add(double range, double reflectivity, double cosine) {
    const double e = reflectivity * cosine / (range * range);
    energy += e;
    moment += e * range;
    ++rays;
  }
};

TEST(BeamWidth, AFlatWallKeepsItsRangeAndIntensity) {
  const Cast out = cast_at(wall(-9, 9, 8.0, 0.6), 0.75);
  ASSERT_EQ(out.record.range_m.size(), 10000u);
  // the mean over a cone of 5 mrad is at most 8 (1 / cos(0.005) - 1) = 1e-4 m longer
  EXPECT_GT(out.record.range_m[0], 8.0);
  EXPECT_LT(out.record.range_m[0], 8.0001);
  EXPECT_NEAR(out.record.intensity[0], 0.6, 1e-4);
  EXPECT_NEAR(out.truth.hit_W_m[0].x(), 8.0f, 1e-5);
}

TEST(BeamWidth, AnEdgeGivesAMixedReturnBetweenItsSurfaces) {
  constexpr double kEdge_m = 0.004, kNear_m = 5.0, kFar_m = 5.4;
  const Cast out = cast_at(wall(kEdge_m, 9, kNear_m, 0.3) + wall(-9, 9, kFar_m, 0.8), 0.75);
  Mixed both;
  int near_rays = 0;
  for (int k = 0; k < kRays; ++k) {
    const Vector3d d = ray(k);
    const bool near = d.y() * kNear_m > kEdge_m;
    near_rays += near;
    both.add((near ? kNear_m : kFar_m) * d.norm(), near ? 0.3 : 0.8, 1.0 / d.norm());
  }
  ASSERT_GT(near_rays, 2);  // both surfaces must contribute
  ASSERT_LT(near_rays, 14);
  ASSERT_EQ(out.record.range_m.size(), 10000u);
  const double range = both.moment / both.energy;
  EXPECT_NEAR(out.record.range_m[0], range, 1e-5);
  EXPECT_NEAR(out.record.intensity[0], both.energy / kRays * range * range, 1e-5);
  // the exact hit lies on the surface of the stronger rays, which is bright and far
  EXPECT_EQ(out.truth.surface_id[0], 1);
  EXPECT_NEAR(out.truth.hit_W_m[0].x(), kFar_m, 1e-5);
}

TEST(BeamWidth, SurfacesFartherApartThanTheEchoDoNotMix) {
  constexpr double kEdge_m = 0.004, kNear_m = 5.0, kFar_m = 6.0;
  const Cast out = cast_at(wall(kEdge_m, 9, kNear_m, 0.3) + wall(-9, 9, kFar_m, 0.8), 0.75);
  Mixed near, far;
  for (int k = 0; k < kRays; ++k) {
    const Vector3d d = ray(k);
    if (d.y() * kNear_m > kEdge_m) {
      near.add(kNear_m * d.norm(), 0.3, 1.0 / d.norm());
    } else {
      far.add(kFar_m * d.norm(), 0.8, 1.0 / d.norm());
    }
  }
  const Mixed& stronger = near.energy > far.energy ? near : far;
  ASSERT_EQ(out.record.range_m.size(), 10000u);
  EXPECT_NEAR(out.record.range_m[0], stronger.moment / stronger.energy, 1e-5);
  EXPECT_EQ(out.truth.surface_id[0], near.energy > far.energy ? 0 : 1);
  // negative control: a longer echo mixes the two surfaces
  const Cast mixed = cast_at(wall(kEdge_m, 9, kNear_m, 0.3) + wall(-9, 9, kFar_m, 0.8), 1.5);
  EXPECT_GT(std::abs(mixed.record.range_m.at(0) - out.record.range_m[0]), 0.05);
}

TEST(BeamWidth, WhatMissesIsMissingFromTheIntensity) {
  constexpr double kEdge_m = 0.004, kWall_m = 5.0;
  const Cast out = cast_at(wall(kEdge_m, 9, kWall_m, 0.6), 0.75);
  int on_wall = 0;
  for (int k = 0; k < kRays; ++k) on_wall += ray(k).y() * kWall_m > kEdge_m;
  ASSERT_GT(on_wall, 0);
  ASSERT_LT(on_wall, kRays);
  ASSERT_EQ(out.record.range_m.size(), 10000u);
  EXPECT_NEAR(out.record.intensity[0], 0.6 * on_wall / kRays, 1e-4);
}

TEST(BeamWidth, SameBitsForAnyNumberOfThreads) {
  const engine::World world = testing::rough_world(60, 40);
  SensorSpec sensor = testing::lidar_of("spinning_lidar");
  sensor.values.set("beam_rays", 5.0);
  const auto motion = testing::moving(0.3, Vector3d(0, 0, 3), Vector3d(2.0, 1.0, 0.5), Vector3d(4.0, 3.0, -8.0));
  const Cast one = cast(world, sensor, motion, 1);
  ASSERT_GT(one.record.range_m.size(), 10000u);
  testing::expect_same(one, cast(world, sensor, motion, 3));
}

TEST(BeamWidth, FractionsOfARayAreRefused) {
  SensorSpec sensor = testing::lidar_of("spinning_lidar");
  sensor.values.set("beam_rays", 2.5);
  EXPECT_THROW(cast(testing::room(), sensor, resting(0.1)), InvalidSituation);
}

}  // namespace
}  // namespace tumble::sim
