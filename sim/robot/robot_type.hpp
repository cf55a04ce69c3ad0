// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

struct RobotType {
  ComponentType component;
  std::string_view file;
  void (*shape)(mjSpec* spec, const Values& values, engine::World& world);
  /// name of the body in the MJCF file that carries all sensor sites; the origin of this body is its centre of mass
  std::string_view sensor_body = "robot";
  std::string_view anchor = "";  ///< static body; empty: free robot
};

const RobotType& rig_robot();
const RobotType& sphere_robot();
const RobotType& pendulum_robot();

std::span<const RobotType* const> all_robot_types();
const RobotType& find_robot_type(std::string_view name);

void move_parts(mjsBody* body, const Eigen::Vector3d& shift_m);
void set_contact(mjsBody* body, double time_s, double damping_ratio);

}  // namespace tumble::sim
