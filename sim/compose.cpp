// SPDX-License-Identifier: BSD-3-Clause
#include "sim/compose.hpp"

#include <algorithm>
#include <new>
#include <string_view>

#include "sim/engine/field_contact.hpp"
#include "sim/engine/near_geoms.hpp"
#include "sim/robot/robot_type.hpp"
#include "sim/simulate.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim::engine {

namespace {

struct SpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using SpecPtr = std::unique_ptr<mjSpec, SpecDeleter>;

constexpr double kStep_s = 0.0005;
constexpr int kFewPairs = 100;

/// Throws std::bad_alloc for a lack of memory. InvalidSituation would be wrong, because a computer with more memory may
/// be able to simulate the situation.
void refuse_for_memory(std::string_view message) {
  if (message.find("ould not allocate") != std::string_view::npos) throw std::bad_alloc();
}

/// Replaces the default error handlers of MuJoCo, which write a log file and end the process on an error.
void install_handlers() {
  static const bool kInstalled = [] {
    mju_user_warning = [](const char*) {};
    mju_user_error = [](const char* message) {
      refuse_for_memory(message);
      throw SimulationFailure(std::string("engine error: ") + message);
    };
    return true;
  }();
  (void)kInstalled;
}

bool touches(const mjModel& model, int geom) {
  return model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
}

int count_pairs(const mjModel& model) {
  int moving = 0, all = 0;
  for (int i = 0; i < model.ngeom; ++i) {
    all += touches(model, i);
    moving += touches(model, i) && model.geom_bodyid[i] != 0;
  }
  return moving * (all - moving);
}

/// Returns true if MuJoCo finds the contacts in the same order with and without its bounding-volume tree. With the
/// tree, MuJoCo sorts the two geoms of a contact by type number. If the robot has several geoms, the function returns
/// false without a comparison.
bool sorts_as_asked(const mjModel& model) {
  int robot = -1;
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_bodyid[i] == 0 || !touches(model, i)) continue;
    if (robot >= 0) return false;
    robot = i;
  }
  if (robot < 0) return false;
  const auto comes_after = [&](int geom) { return model.geom_type[geom] > model.geom_type[robot]; };
  bool after = false;
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_bodyid[i] != 0 || !touches(model, i)) continue;
    if (after && !comes_after(i)) return false;
    after = comes_after(i);
  }
  return true;
}

bool moves_freely(const mjModel& model) {
  const auto none = [](const mjtNum* numbers, int count) {
    return std::all_of(numbers, numbers + count, [](mjtNum number) { return number == 0.0; });
  };
  return NearGeoms::serves(model) && model.ntendon == 0 && model.nu == 0 && model.neq == 0 && model.nplugin == 0 &&
         model.ngravcomp == 0 && model.opt.density == 0.0 && model.opt.viscosity == 0.0 &&
         none(model.jnt_stiffness, model.njnt) && none(model.dof_damping, model.nv) &&
         none(model.dof_frictionloss, model.nv);
}

/// Disables computations of MuJoCo that do not affect the motion, which stays bit-identical.
void spare_work(mjModel& model) {
  model.opt.enableflags |= mjENBL_SLEEP;
  std::fill(model.tree_sleep_policy, model.tree_sleep_policy + model.ntree, static_cast<int>(mjSLEEP_NEVER));
  model.opt.disableflags |= mjDSBL_ISLAND;
  // Part of a height field is always below the robot, so a test of the field's bounding box would exclude no contact.
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_type[i] == mjGEOM_HFIELD)
      std::fill(model.geom_aabb + 6 * i + 3, model.geom_aabb + 6 * i + 6, mjMAXVAL);
  }
  // If there are few pairs of geoms, MuJoCo's bounding-volume tree saves time only if the tree contains only the geoms
  // near the robot.
  if (count_pairs(model) <= kFewPairs && !(NearGeoms::serves(model) && sorts_as_asked(model))) {
    model.opt.disableflags |= mjDSBL_MIDPHASE;
  }
  if (moves_freely(model)) {
    model.opt.disableflags |=
        mjDSBL_SPRING | mjDSBL_DAMPER | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS | mjDSBL_EQUALITY | mjDSBL_ACTUATION;
  }
}

SpecPtr parse(const std::filesystem::path& file) {
  char error[1000] = "";
  SpecPtr spec(mj_parseXML(file.string().c_str(), nullptr, error, sizeof error));
  if (!spec) throw InvalidSituation("model " + file.filename().string() + ": " + error);
  return spec;
}

void move_to_start(mjSpec* spec, std::string_view anchor, const World& world) {
  mjsBody* body = mjs_findBody(spec, std::string(anchor).c_str());
  for (int i = 0; i < 3; ++i) body->pos[i] += world.start_W_m[i];
}

}  // namespace

World compose(const ResolvedSituation& situation, const std::filesystem::path& models) {
  const WorldType& world_type = find_world_type(situation->world.type);
  const RobotType& robot_type = find_robot_type(situation->robot.type);

  install_handlers();
  find_field_contacts_by_geometry();
  World world;
  const SpecPtr spec = parse(models / robot_type.file);
  spec->option.timestep = kStep_s;
  // RK4 is the only integrator of MuJoCo that preserves energy and momentum of a tumbling body.
  spec->option.integrator = mjINT_RK4;
  spec->compiler.usethread = 0;
  robot_type.shape(spec.get(), situation->robot.values, world);
  world_type.build(spec.get(), situation->world.values, situation->seed_of(kWorldStream), world);
  world.free = robot_type.anchor.empty();
  if (!world.free) move_to_start(spec.get(), robot_type.anchor, world);

  world.model.reset(mj_compile(spec.get(), nullptr));
  if (!world.model) refuse_for_memory(mjs_getError(spec.get()));
  if (!world.model) throw InvalidSituation(std::string("model: ") + mjs_getError(spec.get()));
  spare_work(*world.model);
  world.robot_body = mj_name2id(world.model.get(), mjOBJ_BODY, std::string(robot_type.sensor_body).c_str());
  for (const std::string& name : world.surfaces) {
    world.surface_geom.push_back(mj_name2id(world.model.get(), mjOBJ_GEOM, name.c_str()));
  }
  return world;
}

}  // namespace tumble::sim::engine
