// SPDX-License-Identifier: BSD-3-Clause
// The test checks every option of a lidar: when it is off the signal is exactly the ideal one, and when it is on the
// signal changes.
#include "sim/lidar/casting.hpp"
#include "sim/lidar/scene_geometry.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

using testing::Cast;
using testing::cast;
using testing::expect_same;
using testing::Motion;
using testing::moving;
using testing::resting;

using Settings = std::vector<std::pair<const char*, double>>;

struct Option {
  const char* name;
  Settings on;
  Settings off;  ///< option off, with its related numbers at visible values
};

void PrintTo(const Option& option, std::ostream* out) {
  *out << option.name;
}

class LidarOption : public ::testing::TestWithParam<Option> {};

/// Returns a room with a step in it, and a robot with a post.
engine::World stage() {
  return testing::world_of(
      "<mujoco><worldbody><geom type='box' size='3 5 2'/><geom type='box' size='0.5 0.5 2' pos='1.5 1.5 0'/>"
      "<body name='robot' pos='0 0 9'><freejoint/><geom type='capsule' size='0.02 0.2' pos='0.3 0 0' mass='0.1'/>"
      "</body></worldbody></mujoco>");
}

Cast cast_with(const Settings& settings) {
  SensorSpec sensor = testing::exact_lidar_of("spinning_lidar", {{"sees_own_cage", 0.0}});
  for (const auto& [name, value] : settings) sensor.values.set(name, value);
  return cast(stage(), sensor, moving(0.2, Vector3d(-0.5, 0.3, 0.1), Vector3d(1, 0, 0), Vector3d(3, -5, 8)));
}

TEST_P(LidarOption, OffIsExactlyIdeal) {
  expect_same(cast_with(GetParam().off), cast_with({}));
}

TEST_P(LidarOption, OnShows) {
  const Cast on = cast_with(GetParam().on), ideal = cast_with({});
  const bool differs = on.record.position_L_m != ideal.record.position_L_m ||
                       on.record.intensity != ideal.record.intensity || on.record.offset_ns != ideal.record.offset_ns;
  EXPECT_EQ(differs, true);
}

INSTANTIATE_TEST_SUITE_P(
    , LidarOption,
    ::testing::Values(
        Option{"range_noise", {{"range_noise_m", 0.02}}, {{"range_noise_m", 0.0}}},
        Option{"range_quantum", {{"range_quantum_m", 0.005}}, {{"range_quantum_m", 0.0}}},
        Option{"range_min", {{"range_min_m", 2.0}}, {{"range_min_m", 0.0}}},
        Option{"range_max", {{"range_max_m", 2.0}}, {{"range_max_m", 10000.0}}},
        Option{"detection",
               {{"detection_range_m", 3.0}},
               {{"detection_range_m", 0.0}, {"detection_steepness", 0.5}, {"detection_reflectivity", 1.0}}},
        Option{"dropout", {{"dropout_share", 0.1}}, {{"dropout_share", 0.0}}},
        Option{"sweep_dropout", {{"sweep_dropout_share", 0.5}}, {{"sweep_dropout_share", 0.0}}},
        Option{"start_delay", {{"start_delay_s", 0.05}}, {{"start_delay_s", 0.0}}},
        Option{"intensity_quantum", {{"intensity_quantum", 0.1}}, {{"intensity_quantum", 0.0}}},
        Option{"beam_width",
               {{"beam_rays", 7.0}},
               {{"beam_rays", 1.0},
                {"divergence_horizontal_rad", 0.1},
                {"divergence_vertical_rad", 0.1},
                {"echo_length_m", 50.0}}},
        Option{"own_cage", {{"sees_own_cage", 1.0}}, {{"sees_own_cage", 0.0}}},
        Option{"current_driver_timing", {{"current_driver_timing", 1.0}}, {{"current_driver_timing", 0.0}}},
        Option{"driver_stamp_fault", {{"driver_stamp_fault", 1.0}}, {{"driver_stamp_fault", 0.0}}},
        Option{"mirror_radius", {{"mirror_radius_m", 0.0}}, {{"mirror_radius_m", 0.04638}}},
        Option{"mirror_drop", {{"mirror_drop_m", 0.0}}, {{"mirror_drop_m", 0.010875}}}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(RosetteLidar, Mid40IsTheMiddleUnitOfAMid100) {
  SensorSpec sensor = testing::exact_lidar_of("rosette_lidar");
  const Motion motion = moving(0.2, Vector3d(-0.5, 0.3, 0.1), Vector3d(1, 0, 0), Vector3d(3, -5, 8));
  const Cast three = cast(stage(), sensor, motion);
  sensor.values.set("units", 1.0);
  const Cast one = cast(stage(), sensor, motion);
  ASSERT_EQ(one.record.range_m.size(), 20000u);
  ASSERT_EQ(three.record.range_m.size(), 60000u);
  for (std::size_t i = 0; i < 20000; ++i) {
    ASSERT_EQ(three.record.ring[3 * i + 1], 1);
    // the unit's position in the packets differs, which changes the last bit
    EXPECT_LT((one.record.position_L_m[i] - three.record.position_L_m[3 * i + 1]).norm(), 2e-6f);
    EXPECT_EQ(one.record.offset_ns[i], three.record.offset_ns[3 * i + 1]);
  }
}

/// The field of view is 38.4 degrees for one unit; three units at 30 degrees have 98.4 by 38.4 (data sheet).
TEST(RosetteLidar, FieldOfViewIsTheDataSheets) {
  const Cast out = cast(testing::room(), testing::exact_lidar_of("rosette_lidar"), resting(1.0));
  double left = 0.0, right = 0.0, up = 0.0;
  ASSERT_EQ(out.record.range_m.size(), 300000u);
  for (const Vector3f& p : out.record.position_L_m) {
    const double azimuth = std::atan2(p.y(), p.x());
    left = std::max(left, azimuth);
    right = std::min(right, azimuth);
    up = std::max<double>(up, std::atan2(p.z(), std::hypot(p.x(), p.y())));
  }
  // the fitted pattern reaches 19.2 degrees within its tolerance of 0.15
  EXPECT_NEAR(left * 180.0 / M_PI, 49.2, 0.15);
  EXPECT_NEAR(right * 180.0 / M_PI, -49.2, 0.15);
  EXPECT_NEAR(up * 180.0 / M_PI, 19.2, 0.15);
}

/// Firing sequences that contain a sample of the motion turn at two rates: each firing has its own pose there too.
TEST(SpinningLidar, DeskewIdentityThroughImpacts) {
  Stream chance(7, "test.motion");
  Motion motion = resting(0.2);
  // up to 20 rad/s and 5 m/s, with new values every half millisecond
  for (std::size_t i = 1; i < motion.q_WB.size(); ++i) {
    const Vector3d turn = 0.01 * Vector3d(chance.uniform(-1, 1), chance.uniform(-1, 1), chance.uniform(-1, 1));
    motion.q_WB[i] = motion.q_WB[i - 1] * Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    motion.p_WB_m[i] =
        motion.p_WB_m[i - 1] + 0.0025 * Vector3d(chance.uniform(-1, 1), chance.uniform(-1, 1), chance.uniform(-1, 1));
  }
  const Isometry3d T_BL = testing::mounting();
  for (const double current_timing : {0.0, 1.0}) {
    SensorSpec sensor = testing::exact_lidar_of("spinning_lidar", {{"current_driver_timing", current_timing}});
    const Cast out = cast(testing::room(), sensor, motion, 1, T_BL);
    ASSERT_GT(out.record.range_m.size(), 50000u);
    double worst_m = 0.0;
    std::size_t sweep = 0;
    for (std::size_t i = 0; i < out.record.range_m.size(); ++i) {
      while (i >= out.record.sweep_first[sweep + 1]) ++sweep;
      const std::int64_t time_ns = out.record.sweep_start_ns[sweep] + out.record.offset_ns[i];
      const auto k =
          std::min<std::size_t>(static_cast<std::size_t>(time_ns / testing::kPeriod_ns), motion.q_WB.size() - 2);
      const double share = static_cast<double>(time_ns - static_cast<std::int64_t>(k) * testing::kPeriod_ns) /
                           static_cast<double>(testing::kPeriod_ns);
      const Vector3d p_B = T_BL * out.record.position_L_m[i].cast<double>();
      const Vector3d p_W = motion.p_WB_m[k] + share * (motion.p_WB_m[k + 1] - motion.p_WB_m[k]) +
                           motion.q_WB[k].slerp(share, motion.q_WB[k + 1]) * p_B;
      worst_m = std::max(worst_m, testing::distance_to_walls(p_W));
    }
    // float positions and rays of up to 11 m, and an error of 1e-7 rad of the rate within a slot; measured 3e-6 m
    EXPECT_LT(worst_m, 1e-5) << "current_driver_timing " << current_timing;
  }
}

}  // namespace
}  // namespace tumble::sim
