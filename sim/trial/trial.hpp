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

/// Integrator is the numerical integrator of MuJoCo. The function simulate() uses `runge_kutta_4`; the integrators
/// `euler` and `implicit` exist to show their errors in tests.
enum class Integrator { runge_kutta_4, euler, implicit };

struct TrialOptions {
  double step_s = 0.0;  ///< 0: the simulation's own step
  Integrator integrator = Integrator::runge_kutta_4;
};

/// Trial simulates a robot in its world step by step, with the same model and physics engine as simulate(). The robot
/// starts at its initial pose, without coming to rest on its contacts first. Motion and sensors of `built` are ignored.
class Trial {
 public:
  explicit Trial(const BuiltSituation& built, const TrialOptions& options = {});
  ~Trial();
  Trial(Trial&&) noexcept;

  double step_s() const;
  double mass_kg() const;
  double gravity_m_s2() const;
  Eigen::Matrix3d inertia_B_kg_m2() const;
  double sphere_radius_m() const;  ///< 0: no sphere
  Eigen::Vector3d p_BG_m() const;
  double half_extent_m() const;  ///< limit of |x| and |y|

  BodyState state() const;
  void set_state(const BodyState& state);
  double joint_rad(const std::string& name) const;
  double joint_rate_rad_s(const std::string& name) const;
  void set_joint(const std::string& name, double angle_rad, double rate_rad_s);
  void step(const Wrench& wrench = {});
  std::vector<ContactTruth> contacts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
