// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_type.hpp"

#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

engine::World compose_world(const std::string& type, std::uint64_t seed, const Values& values = {}) {
  Situation situation = tumble_down(1.0, 100.0);
  situation.world = {type, values};
  situation.seed = seed;
  return engine::compose(resolve(situation), models_folder());
}

long count_of(const engine::World& world, const std::string& prefix) {
  return std::count_if(world.surfaces.begin(), world.surfaces.end(),
                       [&](const std::string& name) { return name.starts_with(prefix); });
}

/// Returns the height of the highest surface under a position, by the engine's ray.
double top_m(const engine::World& world, double x_m, double y_m) {
  const engine::DataPtr data(mj_makeData(world.model.get()));
  data->qpos[2] = 100.0;  // moves the robot out of the way
  data->qpos[0] = 15.0;
  mj_forward(world.model.get(), data.get());
  const mjtNum from[3] = {x_m, y_m, 30.0}, down[3] = {0, 0, -1};
  const mjtNum distance_m =
      mj_ray(world.model.get(), data.get(), from, down, nullptr, 1, world.robot_body, nullptr, nullptr);
  return 30.0 - distance_m;
}

class RigWorld : public testing::TestWithParam<const char*> {};

TEST_P(RigWorld, HoldsWhatItSaysAndStartsOnTheGround) {
  Values values;
  values.set("rock_count", 12);
  values.set("trunk_count", 9);
  const engine::World world = compose_world(GetParam(), 3, values);
  EXPECT_EQ(count_of(world, "terrain"), 1);
  EXPECT_EQ(count_of(world, "rock_"), 12);
  EXPECT_EQ(count_of(world, "trunk_"), 9);
  EXPECT_EQ(count_of(world, "building"), 1);
  EXPECT_EQ(std::count(world.surface_geom.begin(), world.surface_geom.end(), -1), 0);
  EXPECT_NEAR(top_m(world, world.start_W_m.x(), 0.0), world.start_W_m.z(), 0.01);
  // the slope descends along +x
  EXPECT_LT(top_m(world, world.start_W_m.x() + 6.0, 0.0), world.start_W_m.z() - 0.8);
}

TEST_P(RigWorld, BelongsToTheSeed) {
  const engine::World a = compose_world(GetParam(), 3), b = compose_world(GetParam(), 3),
                      c = compose_world(GetParam(), 4);
  ASSERT_EQ(a.model->nhfielddata, b.model->nhfielddata);
  ASSERT_GT(a.model->nhfielddata, 0);
  EXPECT_TRUE(std::equal(a.model->hfield_data, a.model->hfield_data + a.model->nhfielddata, b.model->hfield_data));
  EXPECT_FALSE(std::equal(a.model->hfield_data, a.model->hfield_data + a.model->nhfielddata, c.model->hfield_data));
  EXPECT_TRUE(std::equal(a.model->geom_pos, a.model->geom_pos + 3 * a.model->ngeom, b.model->geom_pos));
}

TEST_P(RigWorld, LetsTheRigRestAtTheStart) {
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    Situation situation = tumble_down(0.8, 100.0);
    situation.world.type = GetParam();
    situation.seed = seed;
    const Truth truth = simulate(built(situation)).truth;  // the push starts at 0.5 s
    EXPECT_LT((truth.p_WB_m[900] - truth.p_WB_m[0]).norm(), 0.002) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(, RigWorld, testing::Values("hill", "stairs", "cliff"));

TEST(Stairs, TheRobotMeetsStepsAndNotTheGroundUnderThem) {
  Values values;
  values.set("step_rise_m", 0.2);
  values.set("step_tread_m", 0.3);
  values.set("step_count", 10);
  const engine::World world = compose_world("stairs", 1, values);
  EXPECT_EQ(count_of(world, "step_"), 10);
  for (int i = 1; i <= 10; ++i) {
    for (const double y_m : {-2.3, -0.6, 0.0, 1.7}) {
      EXPECT_NEAR(top_m(world, -8.0 + (i - 0.5) * 0.3, y_m), -0.2 * i, 1e-6) << "step " << i << " at y " << y_m;
    }
  }
  EXPECT_NEAR(top_m(world, -8.0 + 10 * 0.3 + 0.5, 0.0), -2.0, 0.02);
}

TEST(Cliff, FacesAreOneCellDeepAtEveryDrop) {
  Values values;
  for (const char* flat : {"relief_m", "bump_height_m", "rock_count"}) values.set(flat, 0);
  values.set("drop_height_m", 1.5);
  values.set("drop_count", 2);
  values.set("ledge_length_m", 1.53);  // rounded to 1.6
  values.set("ledge_slope_rad", 0.0);
  const engine::World world = compose_world("cliff", 1, values);
  EXPECT_NEAR(top_m(world, -8.0, 0.3), 0.0, 1e-3);
  EXPECT_NEAR(top_m(world, -7.8, 0.3), -1.5, 1e-3);
  EXPECT_NEAR(top_m(world, -6.2, 0.3), -1.5, 1e-3);
  EXPECT_NEAR(top_m(world, -6.0, 0.3), -3.0, 1e-3);
}

TEST(Hill, RuledReliefLeavesStraightContourLines) {
  Values values;
  for (const char* none : {"bump_height_m", "rock_count", "trunk_count", "buildings"}) values.set(none, 0);
  values.set("relief_ruled", 1);
  const engine::World world = compose_world("hill", 2, values);
  EXPECT_EQ(world.surfaces, std::vector<std::string>{"terrain"});
  double relief_m = 0.0;
  for (double x_m = -12.0; x_m < 12.0; x_m += 1.03) {
    EXPECT_NEAR(top_m(world, x_m, 4.03), top_m(world, x_m, -7.51), 1e-4) << x_m;
    relief_m = std::max(relief_m, std::abs(top_m(world, x_m, 0.0) - top_m(world, x_m + 1.0, 0.0)));
  }
  EXPECT_GT(relief_m, 0.05);
}

TEST(Hill, ACrowdedForestIsRefusedInOneLine) {
  Values values;
  values.set("trunk_count", 300);
  values.set("clear_half_width_m", 15.0);
  try {
    compose_world("hill", 1, values);
    FAIL() << "300 trunks found room";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), HasSubstr("the area has no space left; reduce the number of objects of the kind trunk"));
  }
}

}  // namespace
}  // namespace tumble::sim
