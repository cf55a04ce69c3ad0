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

/// One robot in one world, advanced step by step (RK4); its state is that of the body that carries the sensors. Any
/// warning of the engine ends it: a run that lost contacts or numbers is not evidence.
class Physics {
 public:
  /// Works on `world`'s model (the floor's friction changes with the place of the contact, the tree over the world's
  /// geoms with the robot's place, which ends with this). `world` outlives it.
  explicit Physics(World& world);

  double step_s() const { return world_.model->opt.timestep; }
  BodyState state() const;
  /// Throws InvalidSituation for a robot on joints, unless it is where it is already: then the time is set alone.
  void set_state(const BodyState& state);

  /// Angle and rate of a hinge by its name; throws InvalidSituation when the robot has none of that name.
  double joint_rad(const std::string& name) const;
  double joint_rate_rad_s(const std::string& name) const;
  void set_joint(const std::string& name, double angle_rad, double rate_rad_s);

  /// Advances by one step under gravity, contacts and `wrench`, held constant. Throws SimulationFailure with the reason
  /// and the simulated time: a warning of the engine, a state that is not finite, a robot that left its world.
  void step(const Wrench& wrench);

  /// Appends the contacts of the robot with the world that the last step ended with, in no order. They stem from the
  /// last stage of RK4, whose position differs from the state's by an error of second order in the step. `time_ns` is
  /// noted.
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
