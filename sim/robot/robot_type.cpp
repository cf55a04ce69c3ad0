// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/robot_type.hpp"

#include <array>

#include "sim/registry.hpp"

namespace tumble::sim {

std::span<const RobotType* const> all_robot_types() {
  static const std::array<const RobotType*, 3> kTypes = {&rig_robot(), &sphere_robot(), &pendulum_robot()};
  return kTypes;
}

const RobotType& find_robot_type(std::string_view name) {
  return find_entry(all_robot_types(), name, "robot");
}

void move_parts(mjsBody* body, const Eigen::Vector3d& shift_m) {
  for (mjsElement* e = mjs_firstChild(body, mjOBJ_GEOM, 0); e; e = mjs_nextChild(body, e, 0)) {
    mjsGeom* geom = mjs_asGeom(e);
    const bool by_ends = geom->fromto[0] == geom->fromto[0];  // NaN: defined by its centre
    for (int i = 0; i < 3; ++i) {
      if (by_ends) {
        geom->fromto[i] += shift_m[i];
        geom->fromto[i + 3] += shift_m[i];
      } else {
        geom->pos[i] += shift_m[i];
      }
    }
  }
  for (mjsElement* e = mjs_firstChild(body, mjOBJ_SITE, 0); e; e = mjs_nextChild(body, e, 0)) {
    for (int i = 0; i < 3; ++i) mjs_asSite(e)->pos[i] += shift_m[i];
  }
}

void set_contact(mjsBody* body, double time_s, double damping_ratio) {
  for (mjsElement* e = mjs_firstChild(body, mjOBJ_GEOM, 0); e; e = mjs_nextChild(body, e, 0)) {
    mjsGeom* geom = mjs_asGeom(e);
    geom->solref[0] = time_s;
    geom->solref[1] = damping_ratio;
  }
}

}  // namespace tumble::sim
