// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// RobotType is a kind of robot: its parameters, its MJCF file, and the changes that a situation makes to the file.
struct RobotType {
  ComponentType component;
  std::string_view file;  ///< file in the folder of models
  /// Sets mass, inertia, contact and centre of mass of the parsed robot. Fills in com_offset_m and sphere_radius_m of
  /// `world`.
  void (*shape)(mjSpec* spec, const Values& values, engine::World& world);
  /// Body of the MJCF file that carries all sensor sites, with its origin at its centre of mass. The sensor body is
  /// free, or attached by joints below `anchor`.
  std::string_view sensor_body = "robot";
  std::string_view anchor = "";  ///< static body that is moved to the world's start; empty: the robot is free
};

/// Returns the robot type rig: a cage of struts with two IMUs and a lidar.
const RobotType& rig_robot();
/// Returns the robot type sphere, which has an eccentric inner mass.
const RobotType& sphere_robot();
/// Returns the robot type pendulum: three segments in a row on hinges, with an IMU on the lowest segment.
const RobotType& pendulum_robot();

/// Returns all robot types in the order of registration. A new robot type needs a source file and a line in
/// robot_type.cpp.
std::span<const RobotType* const> all_robot_types();
/// Returns the robot type with this name. For an unknown name, throws InvalidSituation with the nearest known name.
const RobotType& find_robot_type(std::string_view name);

/// Moves every geom and site of `body` by `shift_m` in the body's own frame.
void move_parts(mjsBody* body, const Eigen::Vector3d& shift_m);
/// Sets the contact softness of the geoms (time constant and damping ratio, MuJoCo's solref).
void set_contact(mjsBody* body, double time_s, double damping_ratio);

}  // namespace tumble::sim
