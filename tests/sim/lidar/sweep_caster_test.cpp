// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/sweep_caster.hpp"

#include <atomic>
#include <new>

#include "sim/lidar/casting.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "sim/random/philox.hpp"
#include "tests/testing.hpp"

namespace {

std::atomic<long> allocation_count{0};

}  // namespace

// The whole test program counts its allocations, for the test below that allows none.
void* operator new(std::size_t bytes) {
  ++allocation_count;
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
// GCC reports the pair below, inlined, as a mismatch
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tumble::sim {
namespace {

TEST(SweepCaster, ASweepAllocatesNothing) {
  const engine::World world = testing::rough_world(60, 40);
  const auto motion = testing::moving(0.3, Vector3d(0, 0, 3), Vector3d(2.0, 1.0, 0.5), Vector3d(4.0, 3.0, -8.0));
  for (const char* kind : {"spinning_lidar", "rosette_lidar"}) {
    for (const double beam_rays : {1.0, 5.0}) {
      SensorSpec sensor = testing::lidar_of(kind);
      sensor.values.set("beam_rays", beam_rays);
      const SweepCaster caster(world, sensor, Isometry3d::Identity(), motion.track(), 1);
      SweepPoints points;
      points.make_room(caster.firings(0));
      const long before = allocation_count;
      caster.cast_sweep(1, points);
      EXPECT_EQ(allocation_count - before, 0) << kind;
      EXPECT_GT(points.count, 5000u) << kind;
    }
  }
  const long before = allocation_count;
  const std::vector<int> control(10, 1);
  EXPECT_EQ(allocation_count - before, 1) << "negative control " << control.size();
}

/// The test compares with a plain implementation of the generator and the transform in double precision.
TEST(LaneNoise, IsPhiloxAndBoxMuller) {
  const Stream stream(12, "lidar.range");
  const LaneNoiseSource source(stream);
  const auto key_block = stream.block(~std::uint64_t{0});
  LaneNoise noise;
  double worst = 0.0;
  for (std::uint64_t index = 0; index < 500; ++index) {
    const std::uint64_t packet = index * 1000003;
    source.draw(packet, noise);
    for (int i = 0; i < kLanes / 2; ++i) {
      const std::uint64_t counter = packet * (kLanes / 2) + static_cast<std::uint64_t>(i);
      const auto word =
          philox4x32_10({static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), 0, 0},
                        {key_block[0], key_block[1]});
      const double radius = std::sqrt(-2.0 * std::log(((word[0] >> 1) + 0.5) * 0x1p-31));
      const double angle = 2.0 * M_PI * word[1] * 0x1p-32;
      worst = std::max({worst, std::abs(noise.normal[i] - radius * std::cos(angle)),
                        std::abs(noise.normal[i + kLanes / 2] - radius * std::sin(angle))});
      ASSERT_EQ(noise.uniform[i], static_cast<float>(((word[2] >> 9) + 0.5) * 0x1p-23));
      ASSERT_EQ(noise.uniform[i + kLanes / 2], static_cast<float>(((word[3] >> 9) + 0.5) * 0x1p-23));
    }
  }
  // The tolerance is single precision for numbers up to five; near a uniform of one the logarithm loses digits. The
  // largest difference measured is 1.6e-6
  EXPECT_LT(worst, 2e-5);
}

SceneGeometry some_cage() {
  SceneGeometry cage;
  const auto add = [&](ShapeKind kind, const Vector3d& size, const Vector3d& at, double rotation_rad) {
    Shape shape{kind, size, Eigen::AngleAxisd(rotation_rad, Vector3d(1, 1, 0.3).normalized()).toRotationMatrix(), at};
    cage.shapes.push_back({shape, kOwnCage, 0.5f});
  };
  add(ShapeKind::capsule, {0.01, 0.3, 0}, {0.3, 0.1, 0.0}, 0.4);
  add(ShapeKind::cylinder, {0.01, 0.2, 0}, {-0.2, 0.3, 0.05}, 0.0);
  add(ShapeKind::ellipsoid, {0.005, 0.03, 0.08}, {-0.3, -0.3, 0.0}, 0.9);
  add(ShapeKind::box, {0.01, 0.02, 0.1}, {0.1, -0.4, 0.02}, 0.2);
  add(ShapeKind::sphere, {0.01, 0, 0}, {0.0, 0.35, -0.03}, 0.0);
  TriangleMesh mesh;
  mesh.vertices_F_m = {{-0.5f, 0.0f, 0.0f}, {-0.5f, 0.02f, 0.0f}, {-0.5f, 0.01f, 0.05f}};
  mesh.triangles = {{0, 1, 2}};
  cage.meshes.push_back({mesh, kOwnCage, 0.5f});
  return cage;
}

struct Verdicts {
  int hit_packets = 0, refused_hits = 0, packets = 0, admitted = 0;
};

/// Compares the mask of one cage with casting every packet at another.
Verdicts compare(const SceneGeometry& masked, const SceneGeometry& real, const SpinningPattern& pattern) {
  const CageMask mask(masked, pattern);
  const RayScene scene(real);
  FiringBlock block;
  RayPacket rays;
  Verdicts out;
  for (std::int64_t sweep = 0; sweep < 3; ++sweep) {
    for (std::int64_t slot = pattern.first_slot(sweep); slot < pattern.first_slot(sweep + 1); slot += kLanes) {
      pattern.fire(sweep, slot, kLanes, block);
      for (int c = 0; c < pattern.channels(); ++c) {
        aim_in_lidar_axes(block.channel[c], rays);
        for (int i = 0; i < kLanes; ++i) {
          rays.range[i] = 100.0f;
          rays.surface_id[i] = kNothing;
        }
        scene.cast(rays);
        const bool hit = std::any_of(rays.surface_id, rays.surface_id + kLanes, [](int id) { return id != kNothing; });
        const bool admitted = mask.may_hit(block, c);
        ++out.packets;
        out.hit_packets += hit;
        out.admitted += admitted;
        out.refused_hits += hit && !admitted;
      }
    }
  }
  return out;
}

TEST(CageMask, NeverRefusesAHitAndSparesMostPackets) {
  for (const double current_timing : {0.0, 1.0}) {
    SensorSpec sensor = testing::lidar_of("spinning_lidar");
    sensor.values.set("current_driver_timing", current_timing);
    const SpinningPattern pattern(sensor.values);
    const Verdicts v = compare(some_cage(), some_cage(), pattern);
    EXPECT_GT(v.hit_packets, 300);
    EXPECT_EQ(v.refused_hits, 0);
    EXPECT_LT(v.admitted, 2 * v.hit_packets);
    EXPECT_LT(v.admitted, v.packets / 3);
  }
}

TEST(CageMask, NegativeControlTheMaskOfAnotherCageRefusesHits) {
  const SpinningPattern pattern(testing::lidar_of("spinning_lidar").values);
  SceneGeometry moved = some_cage();
  for (SceneShape& part : moved.shapes) part.shape.p_FS_m = part.shape.p_FS_m.reverse().eval();
  EXPECT_GT(compare(moved, some_cage(), pattern).refused_hits, 50);
}

TEST(CageMask, APlaneWithoutEdgeMasksNothing) {
  const SpinningPattern pattern(testing::lidar_of("spinning_lidar").values);
  SceneGeometry plane;
  plane.shapes.push_back(
      {Shape{ShapeKind::plane, Vector3d::Zero(), Eigen::Matrix3d::Identity(), {0, 0, -1}}, -2, 0.5f});
  const Verdicts v = compare(plane, plane, pattern);
  EXPECT_EQ(v.admitted, v.packets);
}

}  // namespace
}  // namespace tumble::sim
