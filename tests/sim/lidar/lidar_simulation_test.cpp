// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/lidar_simulation.hpp"

#include "sim/lidar/casting.hpp"
#include "sim/lidar/scene_geometry.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

using testing::Cast;
using testing::cast;
using testing::distance_to_walls;
using testing::expect_same;
using testing::kPeriod_ns;
using testing::Motion;
using testing::mounting;
using testing::moving;
using testing::resting;
using testing::room;
using testing::room_range;

TEST(LidarParameters, ResolveAndBounds) {
  for (const auto known : {spinning_lidar_parameters(), column_lidar_parameters(), rosette_lidar_parameters()}) {
    for (const Parameter& p : known) {
      EXPECT_GE(p.default_value, p.low) << p.name;
      EXPECT_LE(p.default_value, p.high) << p.name;
      EXPECT_FALSE(p.unit.empty()) << p.name;
    }
  }
  EXPECT_EQ(spinning_lidar_parameters().size(), 40u);
}

/// The test applies a second implementation of the published formula of the rig's driver to a lidar at rest.
TEST(SpinningLidar, RestingInARoomIsExact) {
  SensorSpec sensor = testing::exact_lidar_of("spinning_lidar");
  const Vector3d at(0.4, -1.3, 0.2);
  const Cast out = cast(room(), sensor, resting(0.2, at));
  ASSERT_EQ(out.record.sweep_first, (std::vector<std::uint64_t>{0, 32000, 64000}));
  double worst_m = 0.0, worst_position_m = 0.0;
  for (std::size_t i = 0; i < 32000; ++i) {
    const std::size_t sequence = i / 16;
    const int channel = static_cast<int>(i % 16);
    const double t_s = static_cast<double>(sequence) * 50e-6 + channel * 3e-6;
    ASSERT_EQ(out.record.offset_ns[i], static_cast<std::uint32_t>(std::lround(t_s * 1e9)));
    const double azimuth = 2.0 * M_PI * 10.0 * t_s;
    char name[32];
    std::snprintf(name, sizeof name, "elevation_%02d_rad", channel + 1);
    const double elevation = sensor.values.at(name);
    const Vector3d direction(std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
    const Vector3d origin(0.04638 * std::cos(azimuth), -0.04638 * std::sin(azimuth), -0.010875);
    const double range = room_range(at + origin, direction);
    worst_m = std::max(worst_m, std::abs(out.record.range_m[i] - range));
    worst_position_m =
        std::max(worst_position_m, (out.record.position_L_m[i].cast<double>() - origin - range * direction).norm());
  }
  // rays have float precision: 2^-24 of 6 m over a few operations; measured 1.4e-6 and 1.5e-6 m
  EXPECT_LT(worst_m, 5e-6);
  EXPECT_LT(worst_position_m, 5e-6);
}

/// Negative control of the test above: it detects other published mirror offsets and the opposite sense of rotation.
TEST(SpinningLidar, AnotherMirrorOrSenseIsFound) {
  const Cast right = cast(room(), testing::exact_lidar_of("spinning_lidar"), resting(0.1, Vector3d(0.4, -1.3, 0.2)));
  const auto shift_m = [&](const char* name, double value) {
    SensorSpec sensor = testing::exact_lidar_of("spinning_lidar");
    sensor.values.set(name, value);
    const Cast other = cast(room(), sensor, resting(0.1, Vector3d(0.4, -1.3, 0.2)));
    double worst_m = 0.0;
    for (std::size_t i = 0; i < 32000; ++i) {
      worst_m = std::max<double>(worst_m, (right.record.position_L_m.at(i) - other.record.position_L_m.at(i)).norm());
    }
    return worst_m;
  };
  EXPECT_GT(shift_m("mirror_radius_m", 0.03825), 1e-3);
  EXPECT_GT(shift_m("mirror_drop_m", -0.010875), 1e-3);
  EXPECT_GT(shift_m("clockwise", 0.0), 1.0);
}

TEST(SpinningLidar, RingsCountFromBottomToTop) {
  const Cast out = cast(room(), testing::exact_lidar_of("spinning_lidar"), resting(0.1));
  ASSERT_EQ(out.record.ring.size(), 32000u);
  std::vector<double> elevation_of(16);
  for (std::size_t i = 0; i < 16; ++i) {
    // in the published driver the ring is the channel for the first eight, and 23 - channel for the others
    EXPECT_EQ(out.record.ring[i], i < 8 ? i : 23 - i);
    const Vector3f p = out.record.position_L_m[i];
    elevation_of[out.record.ring[i]] = std::atan2(p.z() + 0.010875, p.head<2>().norm() - 0.04638);
  }
  EXPECT_TRUE(std::is_sorted(elevation_of.begin(), elevation_of.end()));
  EXPECT_NEAR(elevation_of.front(), -15.0328 * M_PI / 180.0, 1e-6);
  EXPECT_NEAR(elevation_of.back(), 14.9860 * M_PI / 180.0, 1e-6);
}

TEST(SpinningLidar, CurrentVendorTimingKeepsItsClockAcrossSweeps) {
  SensorSpec sensor = testing::exact_lidar_of("spinning_lidar", {{"current_driver_timing", 1.0}});
  const Cast out = cast(room(), sensor, resting(0.3));
  const SensorSpec spelled =
      testing::exact_lidar_of("spinning_lidar", {{"firing_period_s", 2.8e-6}, {"sequence_period_s", 55.5e-6}});
  expect_same(out, cast(room(), spelled, resting(0.3)));
  ASSERT_EQ(out.record.sweep_start_ns.size(), 3u);
  // firing sequences start at multiples of 55.5 us: 1802 of them start within the first 0.1 s, the next at 100.011 ms
  EXPECT_EQ(out.record.sweep_first[1], 1802u * 16u);
  EXPECT_EQ(out.record.offset_ns[1802 * 16], 1802u * 55500u - 100000000u);
  EXPECT_EQ(out.record.offset_ns[1802 * 16 + 1], 1802u * 55500u - 100000000u + 2800u);
}

TEST(SpinningLidar, FaultyDriverStampsCompressPackets) {
  SensorSpec sensor = testing::exact_lidar_of("spinning_lidar", {{"driver_stamp_fault", 1.0}});
  const Cast faulty = cast(room(), sensor, resting(0.1));
  const Cast right = cast(room(), testing::exact_lidar_of("spinning_lidar"), resting(0.1));
  EXPECT_EQ(faulty.record.position_L_m, right.record.position_L_m);
  std::uint32_t worst_ns = 0;
  for (std::size_t i = 0; i < 32000; ++i)
    worst_ns = std::max(worst_ns, right.record.offset_ns[i] - faulty.record.offset_ns[i]);
  EXPECT_EQ(worst_ns, 600000u);  // the published error of up to 0.6 ms
  EXPECT_EQ(faulty.record.offset_ns[24 * 16], right.record.offset_ns[24 * 16]);
}

TEST(ColumnLidar, RingsAreEvenlySpacedAndTurnWithTheColumn) {
  const SensorSpec sensor = testing::exact_lidar_of("column_lidar");
  const Cast out = cast(room(), sensor, resting(0.1));
  // there are 1024 columns of four banks, and one bank more, because 24414 ns are 0.06 ns less than a quarter of 0.1 s
  // / 1024
  ASSERT_EQ(out.record.ring.size(), (1024u * 4u + 1u) * 16u);
  double worst_rad = 0.0;
  for (std::size_t i = 0; i < out.record.ring.size(); ++i) {
    const Vector3d direction = out.record.position_L_m[i].cast<double>().normalized();
    const double elevation_rad = (-22.5 + 45.0 * out.record.ring[i] / 63.0) * M_PI / 180.0;
    const double azimuth_rad = -2.0 * M_PI * 1e-8 * out.record.offset_ns[i];  // clockwise, 10 Hz
    const Vector3d expected(std::cos(elevation_rad) * std::cos(azimuth_rad),
                            std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
    worst_rad = std::max(worst_rad, (direction - expected).norm());
  }
  EXPECT_LT(worst_rad, 1e-6) << "float positions";
  // the banks of 16 rings are a quarter of a column apart, rounded to whole ns
  EXPECT_EQ(out.record.ring[0], 0u);
  EXPECT_EQ(out.record.ring[16], 16u);
  EXPECT_EQ(out.record.offset_ns[15], 0u);
  EXPECT_EQ(out.record.offset_ns[16], 97656u / 4u);
  EXPECT_EQ(out.record.offset_ns[64], 97656u);
}

TEST(ColumnLidar, ElevationsShiftFromSweepToSweep) {
  SensorSpec sensor = testing::exact_lidar_of("column_lidar", {{"elevation_shift_share", 0.25}});
  const Cast out = cast(room(), sensor, resting(0.5));
  const auto lowest_rad = [&](std::size_t sweep) {
    std::size_t i = out.record.sweep_first[sweep];
    while (out.record.ring[i] != 0) ++i;  // a sweep may start with another bank of rings
    const Vector3d p = out.record.position_L_m[i].cast<double>();
    return std::asin(p.z() / p.norm());
  };
  const double spacing_rad = 45.0 / 63.0 * M_PI / 180.0;
  EXPECT_NEAR(lowest_rad(1) - lowest_rad(0), 0.25 * spacing_rad, 1e-6);
  EXPECT_NEAR(lowest_rad(4) - lowest_rad(0), 0.0, 1e-6) << "modulo one spacing";
}

TEST(ColumnLidar, RefusesRingsThatAreNoMultipleOf16) {
  SensorSpec sensor = testing::exact_lidar_of("column_lidar", {{"rings", 40.0}});
  EXPECT_THROW(cast(room(), sensor, resting(0.1)), InvalidSituation);
}

TEST(RosetteLidar, FollowsTheFormula) {
  SensorSpec sensor = testing::exact_lidar_of("rosette_lidar");
  const Cast out = cast(room(), sensor, resting(0.2));
  ASSERT_EQ(out.record.sweep_first, (std::vector<std::uint64_t>{0, 30000, 60000}));
  for (std::size_t i = 0; i < 60000; i += 7) {
    const std::size_t firing = i / 3;
    const double t_s = static_cast<double>(firing) * 1e-5;
    const double w1 = 2 * M_PI * 7294 / 60, w2 = -2 * M_PI * 4664 / 60;
    const double y = 0.1713 * std::cos(w1 * t_s) + 0.1744 * std::cos(w2 * t_s) + 0.0022 * std::cos((2 * w1 - w2) * t_s);
    const double z = 0.1713 * std::sin(w1 * t_s) + 0.1744 * std::sin(w2 * t_s) + 0.0022 * std::sin((2 * w1 - w2) * t_s);
    const double yaw = (static_cast<double>(i % 3) - 1.0) * M_PI / 6.0;
    const Vector3d direction = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Vector3d(1.0, y, z).normalized();
    EXPECT_EQ(out.record.ring[i], i % 3);
    EXPECT_EQ(out.record.offset_ns[i] + (i >= 30000 ? 100000000u : 0u), i / 3 * 10000u);
    EXPECT_LT((out.record.position_L_m[i].cast<double>().normalized() - direction).norm(), 1e-6);
    EXPECT_NEAR(out.record.range_m[i], room_range(Vector3d::Zero(), direction), 5e-6);
    EXPECT_LT(std::acos(direction.dot(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Vector3d::UnitX())),
              19.3 * M_PI / 180.0);
  }
}

/// Deskewing with the true pose at each point's time moves every point onto the walls; one pose for all points does
/// not.
TEST(LidarSimulation, DeskewIdentity) {
  const Isometry3d T_BL = mounting();
  const Vector3d rate(9.0, -6.0, 14.0);  // 17.7 rad/s
  const Motion motion = moving(0.2, Vector3d(-0.5, 0.5, 0.1), Vector3d(3.0, -2.0, 1.0), rate);
  for (const char* kind : {"spinning_lidar", "column_lidar", "rosette_lidar"}) {
    const Cast out = cast(room(), testing::exact_lidar_of(kind), motion, 1, T_BL);
    ASSERT_EQ(out.record.sweep_start_ns.size(), 2u) << kind;
    double worst_m = 0.0, worst_hit_m = 0.0, one_pose_mean_m = 0.0;
    std::size_t sweep = 0;
    for (std::size_t i = 0; i < out.record.range_m.size(); ++i) {
      while (i >= out.record.sweep_first[sweep + 1]) ++sweep;
      const double t = 1e-9 * static_cast<double>(out.record.sweep_start_ns[sweep] + out.record.offset_ns[i]);
      const Vector3d p_B = T_BL * out.record.position_L_m[i].cast<double>();
      const auto world_at = [&](double time_s) -> Vector3d {
        return Vector3d(-0.5, 0.5, 0.1) + time_s * Vector3d(3.0, -2.0, 1.0) +
               Eigen::AngleAxisd(rate.norm() * time_s, rate.normalized()) * p_B;
      };
      worst_m = std::max(worst_m, distance_to_walls(world_at(t)));
      worst_hit_m = std::max(worst_hit_m, (world_at(t) - out.truth.hit_W_m[i].cast<double>()).norm());
      one_pose_mean_m += distance_to_walls(world_at(1e-9 * static_cast<double>(out.record.sweep_start_ns[sweep])));
    }
    ASSERT_GT(out.record.range_m.size(), 50000u) << kind;
    one_pose_mean_m /= static_cast<double>(out.record.range_m.size());
    // the tolerance covers float positions and rays of up to 11 m; measured 3e-6 m
    EXPECT_LT(worst_m, 1e-5) << kind;
    EXPECT_LT(worst_hit_m, 1e-5) << kind;
    EXPECT_GT(one_pose_mean_m, 0.5) << kind;
  }
}

TEST(LidarSimulation, SameBitsForAnyNumberOfThreads) {
  const engine::World world = testing::rough_world(60, 40);
  const Motion motion = moving(0.7, Vector3d(0, 0, 3), Vector3d(2.0, 1.0, 0.5), Vector3d(4.0, 3.0, -8.0));
  for (const char* kind : {"spinning_lidar", "column_lidar", "rosette_lidar"}) {
    const Cast one = cast(world, testing::lidar_of(kind), motion, 1);
    ASSERT_GT(one.record.range_m.size(), 10000u);
    expect_same(one, cast(world, testing::lidar_of(kind), motion, 2));
    expect_same(one, cast(world, testing::lidar_of(kind), motion, 5));
  }
}

TEST(LidarSimulation, SeedChangesTheNoiseAlone) {
  const Cast a = cast(room(), testing::lidar_of("spinning_lidar"), resting(0.1), 1, Isometry3d::Identity(), 1);
  const Cast b = cast(room(), testing::lidar_of("spinning_lidar"), resting(0.1), 1, Isometry3d::Identity(), 2);
  EXPECT_EQ(a.truth.hit_W_m, b.truth.hit_W_m);
  EXPECT_NE(a.record.range_m, b.record.range_m);
}

TEST(LidarSimulation, RangeNoiseHasItsStatistics) {
  SensorSpec sensor = testing::lidar_of("spinning_lidar");
  sensor.values.set("range_quantum_m", 0.0);
  const Cast noisy = cast(room(), sensor, resting(0.4));
  const Cast exact = cast(room(), testing::exact_lidar_of("spinning_lidar"), resting(0.4));
  const std::size_t n = exact.record.range_m.size();
  ASSERT_EQ(noisy.record.range_m.size(), n);
  double sum = 0.0, sum2 = 0.0, lag = 0.0, sum4 = 0.0, before = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = (noisy.record.range_m[i] - exact.record.range_m[i]) / 0.02;
    sum += z;
    sum2 += z * z;
    sum4 += z * z * z * z;
    lag += z * before;
    before = z;
  }
  const double count = static_cast<double>(n);
  // the bounds are five standard errors of 128 000 samples: mean 1/sqrt(n), variance sqrt(2/n), fourth moment
  // sqrt(96/n), lag 1/sqrt(n)
  EXPECT_NEAR(sum / count, 0.0, 5.0 / std::sqrt(count));
  EXPECT_NEAR(sum2 / count, 1.0, 5.0 * std::sqrt(2.0 / count));
  EXPECT_NEAR(sum4 / count, 3.0, 5.0 * std::sqrt(96.0 / count));
  EXPECT_NEAR(lag / count, 0.0, 5.0 / std::sqrt(count));
}

TEST(LidarSimulation, RangesAreWholeQuanta) {
  const Cast out = cast(room(), testing::lidar_of("spinning_lidar"), resting(0.1));
  ASSERT_GT(out.record.range_m.size(), 30000u);
  for (const float range : out.record.range_m) EXPECT_NEAR(range / 0.005 - std::round(range / 0.005), 0.0, 1e-3);
}

TEST(LidarSimulation, SkyGivesNoPoint) {
  const engine::World plane =
      testing::world_of("<mujoco><worldbody><geom type='plane' size='0 0 1'/></worldbody></mujoco>");
  const Cast out = cast(plane, testing::exact_lidar_of("spinning_lidar"), resting(0.1, Vector3d(0, 0, 1)));
  // the eight channels that look down hit the unbounded plane, and none of the others does
  EXPECT_EQ(out.record.range_m.size(), 16000u);
  for (const std::uint16_t ring : out.record.ring) EXPECT_LT(ring, 8);
  const engine::World nothing = testing::world_of("<mujoco><worldbody><light/></worldbody></mujoco>");
  const Cast none = cast(nothing, testing::exact_lidar_of("spinning_lidar"), resting(0.2));
  EXPECT_EQ(none.record.sweep_first, (std::vector<std::uint64_t>{0, 0, 0}));
}

/// By the definition of detection_range_m, half of the returns come back from the wall whose signal is one.
TEST(LidarSimulation, DropOutByRangeAndReflectivity) {
  SensorSpec sensor = testing::lidar_of("rosette_lidar");
  sensor.values.set("units", 1.0);
  sensor.values.set("prism_1_amplitude", 0.0);
  sensor.values.set("prism_2_amplitude", 0.0);
  sensor.values.set("mixed_amplitude", 0.0);
  const auto share_at = [&](double range_m, double grey) {
    const std::string colour = std::to_string(grey) + " " + std::to_string(grey) + " " + std::to_string(grey) + " 1";
    const engine::World wall =
        testing::world_of("<mujoco><worldbody><geom type='box' size='1 50 50' pos='" + std::to_string(range_m + 1.0) +
                          " 0 0' rgba='" + colour + "'/></worldbody></mujoco>");
    return static_cast<double>(cast(wall, sensor, resting(0.2)).record.range_m.size()) / 20000.0;
  };
  const double tolerance = 5.0 * std::sqrt(0.25 / 20000.0);  // five standard errors
  EXPECT_NEAR(share_at(130.0, 0.2), 0.5, tolerance);
  EXPECT_NEAR(share_at(130.0 * std::sqrt(2.0), 0.4), 0.5, tolerance);
  EXPECT_NEAR(share_at(65.0, 0.2), 256.0 / 257.0, tolerance);
  EXPECT_NEAR(share_at(130.0 * std::sqrt(2.0), 0.2), 1.0 / 17.0, tolerance);
  EXPECT_EQ(share_at(259.0, 0.9) > 0.0, true);
  EXPECT_EQ(share_at(262.0, 0.9), 0.0);  // beyond range_max_m
  EXPECT_EQ(share_at(0.8, 0.9), 0.0);    // within range_min_m
  sensor.values.set("dropout_share", 0.3);
  EXPECT_NEAR(share_at(10.0, 0.9), 0.7, tolerance);
}

TEST(LidarSimulation, IntensityIsReflectivityTimesCosine) {
  const engine::World wall = testing::world_of(
      "<mujoco><worldbody><geom type='box' size='1 9 9' pos='5 0 0' rgba='0.6 0.6 0.6 1'/></worldbody></mujoco>");
  SensorSpec sensor = testing::exact_lidar_of("rosette_lidar", {{"intensity_quantum", 0.0}});
  const Cast out = cast(wall, sensor, resting(0.1));
  ASSERT_GT(out.record.range_m.size(), 10000u);
  for (std::size_t i = 0; i < out.record.range_m.size(); ++i) {
    EXPECT_NEAR(out.record.intensity[i], 0.6 * 4.0 / out.record.range_m[i], 1e-5);
  }
}

/// The robot and its post rotate together, so the post hides the same firings for any pose.
TEST(LidarSimulation, OwnCageMovesWithTheLidarAndHousingIsTransparent) {
  const engine::World world = testing::world_of(
      "<mujoco><worldbody><geom type='box' size='3 5 2'/>"
      "<body name='robot' pos='0 0 7'><freejoint/><geom type='cylinder' size='0.05 0.04' mass='1'/>"
      "<geom type='capsule' size='0.02 0.2' pos='0.3 0 0' mass='0.1'/>"
      "<geom type='sphere' size='0.05' pos='0 0.3 0' contype='0' conaffinity='0' "
      "mass='0.1'/></body></worldbody></mujoco>");
  SensorSpec sensor = testing::exact_lidar_of("spinning_lidar", {{"range_min_m", 0.2}});
  const Cast still = cast(world, sensor, resting(0.1));
  const Cast turned = cast(world, sensor, moving(0.1, Vector3d(0.3, 0.2, 0.1), Vector3d(1, 1, 0), Vector3d(5, -3, 12)));
  std::size_t cage_hits = 0;
  ASSERT_EQ(still.record.range_m.size(), 32000u);
  ASSERT_EQ(turned.record.range_m.size(), 32000u);
  for (std::size_t i = 0; i < 32000; ++i) {
    ASSERT_EQ(still.truth.surface_id[i] == kOwnCage, turned.truth.surface_id[i] == kOwnCage);
    if (still.truth.surface_id[i] != kOwnCage) continue;
    ++cage_hits;
    EXPECT_EQ(still.record.range_m[i], turned.record.range_m[i]);
    const Vector3f p = still.record.position_L_m[i];
    EXPECT_NEAR(std::hypot(p.x() - 0.3f, p.y()), 0.02, 1e-5);
    EXPECT_LT((turned.truth.hit_W_m[i] - Vector3f(0.3f, 0.2f, 0.1f)).norm(), 0.7f);
  }
  // beams are radial from the axis: the post covers 2 asin(0.02 / 0.3) = 0.1334 rad of the turn, in all 16 channels
  EXPECT_NEAR(static_cast<double>(cage_hits), 2 * std::asin(0.02 / 0.3) / (2 * M_PI) * 32000, 16);
  sensor.values.set("sees_own_cage", 0.0);
  for (const std::int32_t id : cast(world, sensor, resting(0.1)).truth.surface_id) ASSERT_EQ(id, 0);
}

TEST(LidarSimulation, BadInput) {
  const Motion motion = resting(0.1);
  LidarRecord record;
  LidarTruth truth;
  SensorSpec sensor = testing::lidar_of("spinning_lidar");
  const auto run = [&](const MotionTrack& track) {
    simulate_lidar(room(), sensor, Isometry3d::Identity(), track, 1, 1, record, truth);
  };
  EXPECT_THROW(run({0, motion.p_WB_m, motion.q_WB}), std::invalid_argument);
  EXPECT_THROW(run({kPeriod_ns, motion.p_WB_m, std::span(motion.q_WB).first(3)}), std::invalid_argument);
  run({kPeriod_ns, {}, {}});
  EXPECT_EQ(record.sweep_first, (std::vector<std::uint64_t>{0}));
  sensor.values.set("firing_period_s", 4e-6);
  EXPECT_THROW(run(motion.track()), InvalidSituation);
  sensor.kind = "sonar";
  EXPECT_THROW(run(motion.track()), InvalidSituation);
}

}  // namespace
}  // namespace tumble::sim
