// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string_view>

#include "sim/robot/robot_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kRigParameters = {
    Parameter{"mass_kg", 8.0, 0.5, 100.0, "kg", "whole rig; assumed"},
    Parameter{"inertia_x_kg_m2", 0.14, 0.005, 20.0, "kg m^2",
              "moment of inertia about the first principal axis through the centre of mass; assumed"},
    Parameter{"inertia_ratio_y", 1.15, 0.5, 50.0, "1",
              "moment of inertia about the second principal axis, relative to the first; assumed"},
    Parameter{"inertia_ratio_z", 1.1, 0.5, 50.0, "1",
              "moment of inertia about the third principal axis (z), relative to the first; assumed"},
    Parameter{"inertia_yaw_rad", 0.0, -1.6, 1.6, "rad",
              "angle about z between x and the first principal axis; the cage of rig.xml is rotated by 0.663 rad"},
    Parameter{"contact_time_s", 0.04, 0.005, 0.2, "s",
              "time constant of a contact (MuJoCo solref[0]); a longer time makes the contact softer"},
    Parameter{"contact_damping_ratio", 0.4, 0.05, 1.5, "1",
              "damping ratio of a contact (MuJoCo solref[1]); below 1 the robot bounces"},
    Parameter{"friction", 0.7, 0.0, 2.0, "1", "sliding friction coefficient of the struts"},
    Parameter{"lower_contact_ratio", 1.0, 0.25, 4.0, "1",
              "contact time constant of the four lower struts relative to contact_time_s, because the tubes differ in "
              "padding and wear"},
    Parameter{"upper_contact_ratio", 1.0, 0.25, 4.0, "1",
              "contact time constant of the four upper struts relative to contact_time_s"},
    Parameter{"upright_contact_ratio", 1.0, 0.25, 4.0, "1",
              "contact time constant of the four vertical struts relative to contact_time_s"},
    Parameter{"com_x_m", 0.0, -0.1, 0.1, "m",
              "true minus nominal centre of mass, body axes; estimators do not receive this value"},
    Parameter{"com_y_m", 0.0, -0.1, 0.1, "m", "the same along y"},
    Parameter{"com_z_m", 0.0, -0.1, 0.1, "m", "the same along z"},
};

const char* contact_ratio_of(std::string_view strut) {
  if (strut.starts_with("strut_lower_")) return "lower_contact_ratio";
  if (strut.starts_with("strut_upper_")) return "upper_contact_ratio";
  return "upright_contact_ratio";
}

void shape_rig(mjSpec* spec, const Values& values, engine::World& world) {
  mjsBody* body = mjs_findBody(spec, "robot");
  body->mass = values.at("mass_kg");
  body->inertia[0] = values.at("inertia_x_kg_m2");
  body->inertia[1] = body->inertia[0] * values.at("inertia_ratio_y");
  body->inertia[2] = body->inertia[0] * values.at("inertia_ratio_z");
  body->iquat[0] = std::cos(values.at("inertia_yaw_rad") / 2);
  body->iquat[1] = body->iquat[2] = 0.0;
  body->iquat[3] = std::sin(values.at("inertia_yaw_rad") / 2);
  set_contact(body, values.at("contact_time_s"), values.at("contact_damping_ratio"));
  for (mjsElement* e = mjs_firstChild(body, mjOBJ_GEOM, 0); e; e = mjs_nextChild(body, e, 0)) {
    mjsGeom* geom = mjs_asGeom(e);
    geom->friction[0] = values.at("friction");
    geom->solref[0] *= values.at(contact_ratio_of(mjs_getString(mjs_getName(e))));
  }
  world.com_offset_m = {values.at("com_x_m"), values.at("com_y_m"), values.at("com_z_m")};
  move_parts(body, -world.com_offset_m);
}

}  // namespace

const RobotType& rig_robot() {
  static const RobotType kType{
      {"rig", "cage of twelve struts with two IMUs and a spinning lidar", kRigParameters}, "rig.xml", shape_rig};
  return kType;
}

}  // namespace tumble::sim
