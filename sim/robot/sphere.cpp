// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "sim/robot/robot_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kSphereParameters = {
    Parameter{"radius_m", 0.145, 0.05, 1.0, "m",
              "outer radius of the shell; the published sphere has a diameter of 29 cm"},
    Parameter{"shell_mass_kg", 1.6, 0.05, 50.0, "kg", "mass of the thin shell; source: slip study"},
    Parameter{"inner_mass_kg", 2.6, 0.05, 50.0, "kg",
              "mass of instruments and battery, modelled as a homogeneous ball; source: slip study"},
    Parameter{"inner_radius_m", 0.08, 0.01, 0.9, "m", "radius of the inner ball; assumed"},
    Parameter{
        "inner_x_m", 0.0, -0.03, 0.03, "m",
        "centre of the inner ball relative to the geometric centre, body axes; up to 12 mm per axis in the slip study"},
    Parameter{"inner_y_m", 0.0, -0.03, 0.03, "m", "the same along y"},
    Parameter{"inner_z_m", 0.0, -0.03, 0.03, "m",
              "centre of the inner ball along z; negative: the heavy side is down at the start"},
    Parameter{
        "contact_time_s", 0.004, 0.002, 0.1, "s",
        "time constant of a contact (MuJoCo solref[0]); the hard shell sinks 0.02 mm under the weight of the sphere"},
    Parameter{"contact_damping_ratio", 1.0, 0.05, 1.5, "1", "damping ratio of a contact (MuJoCo solref[1])"},
};

Eigen::Matrix3d inertia(double shell_kg, double radius_m, double inner_kg, double inner_radius_m,
                        const Eigen::Vector3d& d_m) {
  const double own =
      2.0 / 3.0 * shell_kg * radius_m * radius_m + 2.0 / 5.0 * inner_kg * inner_radius_m * inner_radius_m;
  const double reduced_kg = shell_kg * inner_kg / (shell_kg + inner_kg);
  return own * Eigen::Matrix3d::Identity() +
         reduced_kg * (d_m.squaredNorm() * Eigen::Matrix3d::Identity() - d_m * d_m.transpose());
}

void shape_sphere(mjSpec* spec, const Values& values, engine::World& world) {
  mjsBody* body = mjs_findBody(spec, "robot");
  const double shell_kg = values.at("shell_mass_kg"), inner_kg = values.at("inner_mass_kg");
  const double radius_m = values.at("radius_m");
  const Eigen::Vector3d d_m(values.at("inner_x_m"), values.at("inner_y_m"), values.at("inner_z_m"));
  const Eigen::Matrix3d J = inertia(shell_kg, radius_m, inner_kg, values.at("inner_radius_m"), d_m);
  body->mass = shell_kg + inner_kg;
  const double full[6] = {J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)};
  std::copy(full, full + 6, body->fullinertia);
  std::fill(body->inertia, body->inertia + 3, 0.0);  // only one form is accepted

  mjs_asGeom(mjs_findElement(spec, mjOBJ_GEOM, "shell"))->size[0] = radius_m;
  set_contact(body, values.at("contact_time_s"), values.at("contact_damping_ratio"));
  world.sphere_radius_m = radius_m;
  world.com_offset_m = inner_kg / (shell_kg + inner_kg) * d_m;
  move_parts(body, -world.com_offset_m);
}

}  // namespace

const RobotType& sphere_robot() {
  static const RobotType kType{
      {"sphere", "sphere of 29 cm with an eccentric inner mass, three IMUs and a lidar", kSphereParameters},
      "sphere.xml",
      shape_sphere};
  return kType;
}

}  // namespace tumble::sim
