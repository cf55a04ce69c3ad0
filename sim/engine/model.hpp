// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sim/situation.hpp"

namespace tumble::sim::engine {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

struct FrictionPatch {
  double centre_x_m, centre_y_m, half_x_m, half_y_m, yaw_rad, friction;
  bool contains(double x_m, double y_m) const;
};

struct World {
  ModelPtr model;
  /// id of MuJoCo's body that carries the sensors; the inertial frame of this body is the body frame B
  int robot_body = -1;
  bool free = true;                   ///< false: joints attach the robot to the world
  std::vector<std::string> surfaces;  ///< surface id -> name
  std::vector<int> surface_geom;      ///< static geoms visible to lidars
  std::vector<FrictionPatch> patches;
  double half_extent_m = 0;  ///< limit of |x| and |y|
  Eigen::Vector3d start_W_m = Eigen::Vector3d::Zero();
  /// position of the true centre of mass relative to the nominal centre of mass, in body axes; for a sphere, relative
  /// to the geometric centre
  Eigen::Vector3d com_offset_m = Eigen::Vector3d::Zero();
  double sphere_radius_m = 0;  ///< 0 if the robot is not a sphere
};

World copy_of(const World& world);

}  // namespace tumble::sim::engine
