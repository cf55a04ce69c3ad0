// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <string>

#include "sim/robot/robot_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kPendulumParameters = {
    Parameter{"height_m", 1.3, 0.2, 20.0, "m", "height of the uppermost hinge above the ground; assumed"},
    Parameter{
        "segment_m", 0.25, 0.02, 2.0, "m",
        "length of each segment between hinges; 1.46 s and 0.67 s are the periods of the real pendulum (RepoIMU)"},
    Parameter{"segment_mass_kg", 0.3, 0.01, 20.0, "kg",
              "mass of each segment; assumed, because the free motion does not depend on the mass"},
    Parameter{"hinge_damping_nm_s", 0.0, 0.0, 1.0, "N m s", "viscous friction of each hinge"},
    Parameter{"hinge_friction_nm", 0.0, 0.0, 1.0, "N m", "dry friction of each hinge"},
    Parameter{"play_stiffness_nm", 20.0, 0.1, 1000.0, "N m/rad",
              "stiffness of the support against twist and against swinging along the hinges; assumed"},
    Parameter{"play_damping_nm_s", 0.1, 0.0, 10.0, "N m s", "damping of the support; assumed"},
};

constexpr double kBarHalfThickness_m = 0.02;
constexpr int kSegments = 3;

mjsJoint* joint(mjSpec* spec, const std::string& name) {
  return mjs_asJoint(mjs_findElement(spec, mjOBJ_JOINT, name.c_str()));
}

void shape_segment(mjSpec* spec, const Values& values, int number) {
  const std::string name = "segment_" + std::to_string(number);
  const double length_m = values.at("segment_m"), mass_kg = values.at("segment_mass_kg");
  mjsBody* body = mjs_findBody(spec, name.c_str());
  body->pos[2] = number == 1 ? -0.5 * length_m : -length_m;
  body->mass = mass_kg;
  body->inertia[0] = body->inertia[1] = mass_kg * length_m * length_m / 12.0;
  body->inertia[2] = 0.5 * mass_kg * kBarHalfThickness_m * kBarHalfThickness_m;
  mjs_asGeom(mjs_findElement(spec, mjOBJ_GEOM, ("part_" + name).c_str()))->size[2] = 0.5 * length_m;
  mjsJoint* hinge = joint(spec, "hinge_" + std::to_string(number));
  hinge->pos[2] = 0.5 * length_m;
  hinge->damping[0] = values.at("hinge_damping_nm_s");
  hinge->frictionloss = values.at("hinge_friction_nm");
}

void shape_pendulum(mjSpec* spec, const Values& values, engine::World& world) {
  mjs_findBody(spec, "support")->pos[2] = values.at("height_m");
  for (int number = 1; number <= kSegments; ++number) shape_segment(spec, values, number);
  for (const char* name : {"play_twist", "play_sideways"}) {
    mjsJoint* play = joint(spec, name);
    play->pos[2] = 0.5 * values.at("segment_m");
    play->stiffness[0] = values.at("play_stiffness_nm");
    play->damping[0] = values.at("play_damping_nm_s");
  }
  world.com_offset_m.setZero();
}

}  // namespace

const RobotType& pendulum_robot() {
  static const RobotType kType{
      {"pendulum", "three segments in a row on hinges, with an IMU on the lowest segment", kPendulumParameters},
      "pendulum.xml",
      shape_pendulum,
      "segment_3",
      "support"};
  return kType;
}

}  // namespace tumble::sim
