// SPDX-License-Identifier: BSD-3-Clause
// The test uses synthetic poses of a sensor over and under a slope, whose depth is known in closed form.
#include "sim/truth/above_ground.hpp"

#include "sim/engine/height_field.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kSlope = 0.5;

/// Returns 6 m x 4 m of ground that rises along x, 1.6 m high in the middle, with a rock next to it.
engine::World slope() {
  engine::World world = testing::world_of(
      "<mujoco><asset><hfield name='ground' nrow='5' ncol='7' size='3 2 3 0.3'/></asset><worldbody><geom type='hfield' "
      "hfield='ground' pos='0 0 0.1'/><geom type='sphere' size='0.5' pos='0 0 4'/></worldbody></mujoco>");
  for (int i = 0; i < world.model->nhfielddata; ++i) world.model->hfield_data[i] = static_cast<float>(i % 7) / 6.0f;
  return world;
}

/// Returns a body at rest with a sensor 0.2 m in front of it; the sensor is `depth_m` below the slope for some of 200
/// steps of 0.5 ms, which end with the recording or before it, and otherwise 0.3 m above it.
Truth dip(double depth_m, int steps, int steps_after = 50) {
  Truth truth;
  const double upright = std::sqrt(1.0 + kSlope * kSlope);
  for (int k = 0; k < 200; ++k) {
    const bool in = k >= 200 - steps_after - steps && k < 200 - steps_after;
    const double y_m = -1.3, x_m = 0.4, below_m = (in ? depth_m : -0.3) * upright;
    truth.p_WB_m.emplace_back(x_m - 0.2, y_m, 1.6 + kSlope * x_m - below_m);
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
  }
  return truth;
}

const Vector3d kSensor_B_m(0.2, 0.0, 0.0);

TEST(AboveGround, ASensorThatStaysInTheGroundFailsTheDraw) {
  const engine::World world = slope();
  for (const int steps_after : {50, 0}) {
    try {
      require_above_ground(world, dip(0.04, 110, steps_after), "lidar", kSensor_B_m);
      FAIL() << "a lidar in the ground for 55 ms went through";
    } catch (const SimulationFailure& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("'lidar'"), HasSubstr("0.055 s"), HasSubstr("0.04 m deep"),
                                      HasSubstr("0.01 m for 0.05 s at most"),
                                      HasSubstr(steps_after == 50 ? "from 0.02 s" : "from 0.045 s")));
    }
  }
}

TEST(AboveGround, AShortOrShallowDipIsTheGiveOfAContact) {
  const engine::World world = slope();
  EXPECT_NO_THROW(require_above_ground(world, dip(0.04, 100), "lidar", kSensor_B_m));  // 50 ms
  EXPECT_NO_THROW(require_above_ground(world, dip(0.009, 150), "lidar", kSensor_B_m));
  EXPECT_THROW(require_above_ground(world, dip(0.011, 150), "lidar", kSensor_B_m), SimulationFailure);
}

TEST(AboveGround, TwoShortDipsAreNotOneLong) {
  Truth twice = dip(0.04, 90);
  twice.p_WB_m[100].z() += 0.5;
  EXPECT_NO_THROW(require_above_ground(slope(), twice, "lidar", kSensor_B_m));
  Truth longer = dip(0.04, 120);
  longer.p_WB_m[31].z() += 0.5;  // outside once near the start; the remaining interval is still long
  EXPECT_THROW(require_above_ground(slope(), longer, "lidar", kSensor_B_m), SimulationFailure);
}

TEST(AboveGround, BesideTheFieldThereIsNoGround) {
  Truth outside = dip(0.5, 150);
  for (Vector3d& p_m : outside.p_WB_m) p_m.y() = 2.1;
  EXPECT_NO_THROW(require_above_ground(slope(), outside, "lidar", kSensor_B_m));
}

TEST(AboveGround, DepthIsTheDistanceFromTheTriangleAbove) {
  engine::World world = testing::world_of(
      "<mujoco><asset><hfield name='ground' nrow='2' ncol='2' size='1 1 1 0.3'/></asset><worldbody><geom type='hfield' "
      "hfield='ground'/></worldbody></mujoco>");
  world.model->hfield_data[1] = 1.0f;  // only the corner +x -y is high, so the upper half is level
  const engine::Field field(*world.model, 0);
  EXPECT_NEAR(field.depth_m({-0.5, 0.5, -0.2}), 0.2, 1e-12);
  EXPECT_NEAR(field.depth_m({0.5, -0.5, 0.2}), 0.3 / std::sqrt(1.5), 1e-12);  // height of 0.5 there, slopes of 0.5
  EXPECT_NEAR(field.depth_m({0.5, -0.5, 0.8}), -0.3 / std::sqrt(1.5), 1e-12);
}

}  // namespace
}  // namespace tumble::sim
