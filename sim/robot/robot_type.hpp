// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// A kind of robot: its parameters, its MJCF file and how a draw changes it.
struct RobotType {
  ComponentType component;
  std::string_view file;  ///< in the folder of models
  /// Sets mass, inertia, contact and centre of mass of the parsed robot; fills com_offset_m and sphere_radius_m of
  /// `world`.
  void (*shape)(mjSpec* spec, const Values& values, engine::World& world);
  /// Body of the file that carries the sensors, its origin at its centre of mass: a free body, or one that hangs on
  /// joints below `anchor`. Sites of sensors are on it alone.
  std::string_view sensor_body = "robot";
  std::string_view anchor = "";  ///< body that stands still, moved to the world's start; "": the robot is free
};

/// Cage of struts with two IMUs and a lidar.
const RobotType& rig_robot();
/// Sphere with an off-centre inside.
const RobotType& sphere_robot();
/// Three segments that hang one from the other on hinges, an IMU on the lowest.
const RobotType& pendulum_robot();

/// All kinds, in the order of registration: a new one is a file and a line in robot_type.cpp.
std::span<const RobotType* const> all_robot_types();
/// Throws InvalidSituation, naming the nearest known type.
const RobotType& find_robot_type(std::string_view name);

/// Moves every geom and site of `body` by `shift_m` in its own frame.
void move_parts(mjsBody* body, const Eigen::Vector3d& shift_m);
/// Sets softness of contact of the geoms (time constant and damping ratio, MuJoCo's solref).
void set_contact(mjsBody* body, double time_s, double damping_ratio);

}  // namespace tumble::sim
