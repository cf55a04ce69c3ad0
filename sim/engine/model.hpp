// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sim/situation.hpp"

/// Private to sim: the only headers that include mujoco.h are in this folder and beside the sources that need them.
namespace tumble::sim::engine {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

/// A rectangle of floor with its own sliding friction; where the robot touches inside of it, it holds.
struct FrictionPatch {
  double centre_x_m, centre_y_m, half_x_m, half_y_m, yaw_rad, friction;
  bool contains(double x_m, double y_m) const;
};

/// A compiled situation: world and robot in one model.
struct World {
  ModelPtr model;
  /// Id of the robot's body that carries the sensors (its frame is B: inertial frame position zero).
  int robot_body = -1;
  bool free = true;                   ///< that body is the whole robot and floats; else it hangs on joints
  std::vector<std::string> surfaces;  ///< surface id -> name; parallel to `surface_geom`
  std::vector<int> surface_geom;      ///< surface id -> geom id: the static geoms that a lidar sees and a robot touches
  std::vector<FrictionPatch> patches;
  double half_extent_m = 0;                                ///< beyond this |x| or |y| the robot has left the world
  Eigen::Vector3d start_W_m = Eigen::Vector3d::Zero();     ///< on the ground, where a robot begins; +x leads away
  Eigen::Vector3d com_offset_m = Eigen::Vector3d::Zero();  ///< true centre of mass in the robot's design frame, B axes
  double sphere_radius_m = 0;                              ///< 0 when the robot is not a sphere
};

/// The same with a model of its own, for who changes it: the physics (a floor's friction), a trial, a picture's look.
World copy_of(const World& world);

}  // namespace tumble::sim::engine
