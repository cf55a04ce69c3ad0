// SPDX-License-Identifier: BSD-3-Clause
#include "sim/truth/above_ground.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>
#include <vector>

#include "sim/engine/height_field.hpp"
#include "sim/simulate.hpp"

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

struct Terrain {
  engine::Field field;
  Eigen::Isometry3d T_WF;

  Terrain(const mjModel& model, int geom) : field(model, geom), T_WF(Eigen::Isometry3d::Identity()) {
    const mjtNum* q = model.geom_quat + 4 * geom;
    T_WF.translation() = Vector3d::Map(model.geom_pos + 3 * geom);
    T_WF.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }
  double depth_m(const Vector3d& p_W_m) const { return field.depth_m(T_WF.inverse() * p_W_m); }
};

std::vector<Terrain> terrains(const engine::World& world) {
  std::vector<Terrain> found;
  for (const int geom : world.surface_geom) {
    if (world.model->geom_type[geom] == mjGEOM_HFIELD) found.emplace_back(*world.model, geom);
  }
  return found;
}

struct Spell {
  std::size_t steps = 0;
  double deepest_m = 0.0;
};

[[noreturn]] void fail(const std::string& sensor, const Spell& spell, double from_s, double period_s) {
  std::ostringstream text;
  text << "sensor '" << sensor << "' was below the ground for " << static_cast<double>(spell.steps) * period_s << " s, "
       << spell.deepest_m << " m deep (deeper than " << kDipDepth_m << " m for " << kDip_s
       << " s at most): the robot was wedged in the ground, from " << from_s << " s";
  throw SimulationFailure(text.str());
}

}  // namespace

void require_above_ground(const engine::World& world, const Truth& truth, const std::string& sensor,
                          const Vector3d& p_BX_m) {
  const std::vector<Terrain> ground = terrains(world);
  if (ground.empty()) return;
  const double period_s = static_cast<double>(truth.period_ns) * 1e-9;
  Spell spell;
  for (std::size_t k = 0; k <= truth.p_WB_m.size(); ++k) {
    double depth_m = 0.0;
    if (k < truth.p_WB_m.size()) {
      const Vector3d p_W_m = truth.p_WB_m[k] + truth.q_WB[k] * p_BX_m;
      for (const Terrain& terrain : ground) depth_m = std::max(depth_m, terrain.depth_m(p_W_m));
    }
    if (depth_m > kDipDepth_m) {
      spell = {spell.steps + 1, std::max(spell.deepest_m, depth_m)};
      continue;
    }
    if (static_cast<double>(spell.steps) * period_s > kDip_s)
      fail(sensor, spell, static_cast<double>(k - spell.steps) * period_s, period_s);
    spell = {};
  }
}

}  // namespace tumble::sim
