// SPDX-License-Identifier: BSD-3-Clause
#include "sim/built_situation.hpp"

#include <unistd.h>

#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "sim/engine/worlds.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/render/renderer.hpp"
#include "sim/simulate.hpp"
#include "sim/trial/ray_trial.hpp"
#include "sim/trial/trial.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

// A function that needs a complete situation cannot be called with an incomplete one; a function that needs a world
// cannot be called with a situation.
static_assert(!std::is_default_constructible_v<ResolvedSituation>);
static_assert(!std::is_constructible_v<ResolvedSituation, Situation>);
static_assert(!std::is_assignable_v<ResolvedSituation&, Situation>);
static_assert(!std::is_convertible_v<ResolvedSituation&, Situation&>, "no number of a resolved one is changed");
static_assert(std::is_same_v<decltype(resolve(std::declval<Situation>())), ResolvedSituation>);
static_assert(!std::is_constructible_v<BuiltSituation, Situation, fs::path>);
template <typename World>
concept Serves = std::is_constructible_v<Surface, World> && std::is_constructible_v<Renderer, World> &&
    std::is_constructible_v<Trial, World> && std::is_invocable_v<decltype(&start_pose), World> &&
    std::is_invocable_v<decltype(&simulate), World, int> &&
    std::is_invocable_v<decltype(&compare_rays), World, RayTrialOptions>;
template <typename World>
concept ServesAny = std::is_constructible_v<Surface, World> || std::is_constructible_v<Renderer, World> ||
    std::is_constructible_v<Trial, World> || std::is_invocable_v<decltype(&start_pose), World> ||
    std::is_invocable_v<decltype(&simulate), World, int> ||
    std::is_invocable_v<decltype(&compare_rays), World, RayTrialOptions>;
static_assert(Serves<const BuiltSituation&>);
static_assert(!ServesAny<const Situation&> && !ServesAny<const ResolvedSituation&>);

/// Returns a sphere that begins on a slippery patch: the physics changes the floor's friction in its model.
Situation on_a_patch() {
  Situation situation = roll_along(2.0);
  situation.world.values.set("patch_1_x_m", 0.0);
  situation.world.values.set("patch_1_half_x_m", 2.0);
  situation.world.values.set("patch_1_half_y_m", 2.0);
  situation.world.values.set("patch_1_friction", 0.1);
  return situation;
}

double floor_friction(const engine::World& world) {
  return world.model->geom_friction[3 * mj_name2id(world.model.get(), mjOBJ_GEOM, "floor")];
}

TEST(BuiltSituation, IsNotChangedByWhatIsDoneWithIt) {
  const BuiltSituation shared = built(on_a_patch());
  const double before = floor_friction(shared.world());
  engine::World own = engine::copy_of(shared.world());
  engine::Physics physics(own);
  physics.step({});
  ASSERT_NE(floor_friction(own), before) << "or nothing would be seen";

  const Truth first = simulate(shared).truth;
  Trial(shared, {0.001}).step();
  const Truth second = simulate(shared).truth, anew = simulate(built(on_a_patch())).truth;
  EXPECT_EQ(floor_friction(shared.world()), before);
  EXPECT_EQ(Trial(shared).step_s(), 0.0005);
  EXPECT_EQ(second.p_WB_m, first.p_WB_m);
  EXPECT_EQ(second.w_WB_B_rad_s, first.w_WB_B_rad_s);
  EXPECT_EQ(anew.p_WB_m, first.p_WB_m) << "as from a world of its own";
  EXPECT_EQ(anew.w_WB_B_rad_s, first.w_WB_B_rad_s);
}

TEST(BuiltSituation, CopiesShareTheWorld) {
  const BuiltSituation shared = built(on_a_patch());
  const BuiltSituation copy = shared;  // NOLINT: that a copy is made is what is tested
  EXPECT_EQ(&copy.world(), &shared.world());
  EXPECT_EQ(copy.situation(), resolve(on_a_patch()));
}

// The robot's file is read wherever a world is composed: without that file everything except composing works.
TEST(BuiltSituation, NothingThatIsMadeFromItComposesAgain) {
  const fs::path models = fs::temp_directory_path() / ("tumble_built_" + std::to_string(getpid()));
  fs::create_directories(models);
  fs::copy_file(models_folder() / "rig.xml", models / "rig.xml");
  const BuiltSituation only(resolve(tumble_down(1.0, 100.0)), models);
  fs::remove_all(models);
  ASSERT_THROW(BuiltSituation(resolve(tumble_down(1.0, 100.0)), models), InvalidSituation);

  EXPECT_EQ(simulate(only).truth.p_WB_m, simulate(built(tumble_down(1.0, 100.0))).truth.p_WB_m);
  EXPECT_GT(start_pose(only).translation().norm(), 0.0);
  EXPECT_EQ(Surface(only).distances(std::vector<Vector3f>{{0.0f, 0.0f, 50.0f}}, 1.0f).front(), 1.0f);
  EXPECT_GT(Trial(only).mass_kg(), 1.0);
  EXPECT_EQ(compare_rays(only, {100}).rays, 100);
}

/// Returns the position and velocity of a robot after half a second's fall onto its ground.
BodyState fallen(engine::World world) {
  engine::Physics physics(world);
  BodyState state = physics.state();
  if (world.free) {
    state.p_WB_m = world.start_W_m + Vector3d(0.3, 0.1, 0.4);
    state.w_WB_B_rad_s = {2.0, 9.0, -3.0};
    physics.set_state(state);
  }
  Wrench push;
  push.torque_W_nm = {0.02, 0.05, 0.0};
  for (int k = 0; k < 1000; ++k) physics.step(push);
  return physics.state();
}

bool same_bits(const BodyState& a, const BodyState& b) {
  return a.p_WB_m == b.p_WB_m && a.q_WB.coeffs() == b.q_WB.coeffs() && a.v_WB_m_s == b.v_WB_m_s &&
         a.w_WB_B_rad_s == b.w_WB_B_rad_s;
}

TEST(BuiltSituation, WhatTheEngineIsSparedChangesNoBit) {
  Situation swinging = roll_along(1.0);
  swinging.robot.type = "pendulum";
  swinging.motion = {"swing", {}};
  for (const Situation& situation : {tumble_down(1.0, 100.0), roll_along(1.0), swinging}) {
    SCOPED_TRACE(situation.robot.type);
    const BuiltSituation spared = built(situation);
    engine::World whole = engine::copy_of(spared.world());
    ASSERT_NE(whole.model->opt.enableflags | whole.model->opt.disableflags, 0);
    whole.model->opt.enableflags = 0;
    // for a sphere the engine tests every pair, whatever a tree contains; contacts of a rig have the order of the
    // engine's tree
    whole.model->opt.disableflags = situation.robot.type == "sphere" ? mjDSBL_MIDPHASE : 0;
    for (int i = 0; i < whole.model->ngeom; ++i) {  // a bounding box as from the compiler
      if (whole.model->geom_type[i] == mjGEOM_HFIELD)
        std::fill(whole.model->geom_aabb + 6 * i + 3, whole.model->geom_aabb + 6 * i + 6, 30.0);
    }
    engine::World other = engine::copy_of(whole);
    other.model->opt.gravity[2] *= 1.0 + 1e-9;
    const BodyState expected = fallen(std::move(whole));
    EXPECT_TRUE(same_bits(fallen(engine::copy_of(spared.world())), expected));
    EXPECT_FALSE(same_bits(fallen(std::move(other)), expected));  // negative control: a changed bit is detected
  }
}

}  // namespace
}  // namespace tumble::sim
