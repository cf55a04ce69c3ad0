// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sim/body_state.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// How the engine integrates. The simulation uses `runge_kutta_4`; the others are there to be shown wrong.
enum class Integrator { runge_kutta_4, euler, implicit };

struct TrialOptions {
  double step_s = 0.0;  ///< 0: the simulation's own
  Integrator integrator = Integrator::runge_kutta_4;
};

/// A robot in its world, moved by hand, step by step: the very model and engine of `simulate`, open to measurement.
/// No motion, no sensors, no settling; the motion and sensors of the situation are ignored.
class Trial {
 public:
  /// Moves a copy of the world. Throws InvalidSituation when the step is out of its bounds.
  explicit Trial(const BuiltSituation& built, const TrialOptions& options = {});
  ~Trial();
  Trial(Trial&&) noexcept;

  double step_s() const;
  double mass_kg() const;
  double gravity_m_s2() const;
  Eigen::Matrix3d inertia_B_kg_m2() const;  ///< about the centre of mass
  double sphere_radius_m() const;           ///< 0 when the robot is not a sphere
  Eigen::Vector3d p_BG_m() const;           ///< geometric centre (design origin) in B
  double half_extent_m() const;             ///< beyond this |x| or |y| the robot has left its world

  BodyState state() const;  ///< of the body that carries the sensors
  /// Throws InvalidSituation for a robot on joints.
  void set_state(const BodyState& state);
  /// Hinges of such a robot by name; throw InvalidSituation when there is none of that name.
  double joint_rad(const std::string& name) const;
  double joint_rate_rad_s(const std::string& name) const;
  void set_joint(const std::string& name, double angle_rad, double rate_rad_s);
  /// One step under gravity, contacts and `wrench`. Throws SimulationFailure.
  void step(const Wrench& wrench = {});
  /// Contacts that the last step ended with; their time is the state's, rounded to nanoseconds.
  std::vector<ContactTruth> contacts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
