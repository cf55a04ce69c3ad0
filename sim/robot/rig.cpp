// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/robot/robot_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"mass_kg", 8.0, 0.5, 100.0, "kg", "whole rig; assumed"},
    Parameter{"inertia_x_kg_m2", 0.14, 0.005, 20.0, "kg m^2",
              "moment of inertia about the x axis through the centre of mass; assumed"},
    Parameter{"inertia_ratio_y", 1.15, 0.7, 1.4, "1", "moment about y over moment about x; assumed"},
    Parameter{"inertia_ratio_z", 1.1, 0.7, 1.4, "1", "moment about z over moment about x; assumed"},
    Parameter{"contact_time_s", 0.04, 0.005, 0.2, "s",
              "time constant of a contact (MuJoCo solref[0]): longer is softer"},
    Parameter{"contact_damping_ratio", 0.4, 0.05, 1.5, "1",
              "damping ratio of a contact (MuJoCo solref[1]): below 1 it bounces"},
    Parameter{"friction", 0.7, 0.0, 2.0, "1", "sliding friction of the struts on everything"},
    Parameter{"com_x_m", 0.0, -0.1, 0.1, "m", "true minus nominal centre of mass, B axes; nobody tells the estimator"},
    Parameter{"com_y_m", 0.0, -0.1, 0.1, "m", "the same along y"},
    Parameter{"com_z_m", 0.0, -0.1, 0.1, "m", "the same along z"},
};

void shape(mjSpec* spec, const Values& values, engine::World& world) {
  mjsBody* body = mjs_findBody(spec, "robot");
  body->mass = values.at("mass_kg");
  body->inertia[0] = values.at("inertia_x_kg_m2");
  body->inertia[1] = body->inertia[0] * values.at("inertia_ratio_y");
  body->inertia[2] = body->inertia[0] * values.at("inertia_ratio_z");
  set_contact(body, values.at("contact_time_s"), values.at("contact_damping_ratio"));
  for (mjsElement* e = mjs_firstChild(body, mjOBJ_GEOM, 0); e; e = mjs_nextChild(body, e, 0)) {
    mjs_asGeom(e)->friction[0] = values.at("friction");
  }
  world.com_offset_m = {values.at("com_x_m"), values.at("com_y_m"), values.at("com_z_m")};
  move_parts(body, -world.com_offset_m);
}

}  // namespace

const RobotType& rig_robot() {
  static const RobotType kType{
      {"rig", "cage of twelve struts with two IMUs and a spinning lidar", kParameters}, "rig.xml", shape};
  return kType;
}

}  // namespace tumble::sim
