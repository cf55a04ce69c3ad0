// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"
#include "sim/engine/near_geoms.hpp"
#include "sim/recording.hpp"

namespace tumble::sim::engine {

/// Physics simulates the robot's motion in steps with MuJoCo. A warning of MuJoCo ends the simulated run, because lost
/// contacts or invalid numbers would falsify the data.
class Physics {
 public:
  /// Each step() may change the floor friction and the bounding-volume tree in MuJoCo's model of `world`. The
  /// destructor resets the bounding-volume tree to its state before the first step(). `world` must outlive the Physics
  /// object.
  explicit Physics(World& world);

  double step_s() const { return world_.model->opt.timestep; }
  BodyState state() const;
  /// Sets the state of the robot. If joints attach the robot to the world, set_state() sets only the time, and throws
  /// InvalidSituation if the pose differs from the current pose.
  void set_state(const BodyState& state);

  double joint_rad(const std::string& name) const;
  double joint_rate_rad_s(const std::string& name) const;
  void set_joint(const std::string& name, double angle_rad, double rate_rad_s);

  /// Simulates one step. Throws SimulationFailure for a warning of MuJoCo, a non-finite state, or a robot outside the
  /// limits of the world.
  void step(const Wrench& wrench);

  /// Appends the current contacts. MuJoCo computes contacts at the last stage of the RK4 integrator, whose position
  /// differs from the position after the step by an error of second order.
  void append_contacts(std::int64_t time_ns, std::vector<ContactTruth>& contacts) const;

 private:
  int hinge(const std::string& name) const;
  void set_floor_friction();
  void check() const;

  World& world_;
  NearGeoms near_geoms_;
  DataPtr data_;
  std::vector<int> surface_of_geom_;
  int floor_geom_ = -1;
  double floor_friction_ = 0.0;
};

}  // namespace tumble::sim::engine
