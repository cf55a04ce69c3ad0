// SPDX-License-Identifier: BSD-3-Clause
#include "sim/trial/trial.hpp"

#include <cmath>

#include "sim/engine/physics.hpp"

namespace tumble::sim {

namespace {

int engine_integrator(Integrator integrator) {
  switch (integrator) {
    case Integrator::runge_kutta_4:
      return mjINT_RK4;
    case Integrator::euler:
      return mjINT_EULER;
    case Integrator::implicit:
      return mjINT_IMPLICIT;
  }
  throw InvalidSituation("trial: unknown integrator");
}

engine::World world_for(const BuiltSituation& built, const TrialOptions& options) {
  if (!(options.step_s >= 0.0 && options.step_s <= 0.1)) {
    throw InvalidSituation("trial: step_s is " + std::to_string(options.step_s) + " s; it must be within [0, 0.1]");
  }
  engine::World world = engine::copy_of(built.world());
  if (options.step_s > 0.0) world.model->opt.timestep = options.step_s;
  world.model->opt.integrator = engine_integrator(options.integrator);
  return world;
}

}  // namespace

struct Trial::Impl {
  engine::World world;
  engine::Physics physics;

  Impl(const BuiltSituation& built, const TrialOptions& options) : world(world_for(built, options)), physics(world) {}
};

Trial::Trial(const BuiltSituation& built, const TrialOptions& options)
    : impl_(std::make_unique<Impl>(built, options)) {}
Trial::~Trial() = default;
Trial::Trial(Trial&&) noexcept = default;

double Trial::step_s() const {
  return impl_->physics.step_s();
}

double Trial::mass_kg() const {
  return impl_->world.model->body_mass[impl_->world.robot_body];
}

double Trial::gravity_m_s2() const {
  return -impl_->world.model->opt.gravity[2];
}

Eigen::Matrix3d Trial::inertia_B_kg_m2() const {
  const mjModel& model = *impl_->world.model;
  const mjtNum* q = model.body_iquat + 4 * impl_->world.robot_body;
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  return R * Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * impl_->world.robot_body).asDiagonal() *
         R.transpose();
}

double Trial::sphere_radius_m() const {
  return impl_->world.sphere_radius_m;
}

Eigen::Vector3d Trial::p_BG_m() const {
  return -impl_->world.com_offset_m;
}

double Trial::half_extent_m() const {
  return impl_->world.half_extent_m;
}

BodyState Trial::state() const {
  return impl_->physics.state();
}

void Trial::set_state(const BodyState& state) {
  impl_->physics.set_state(state);
}

double Trial::joint_rad(const std::string& name) const {
  return impl_->physics.joint_rad(name);
}

double Trial::joint_rate_rad_s(const std::string& name) const {
  return impl_->physics.joint_rate_rad_s(name);
}

void Trial::set_joint(const std::string& name, double angle_rad, double rate_rad_s) {
  impl_->physics.set_joint(name, angle_rad, rate_rad_s);
}

void Trial::step(const Wrench& wrench) {
  impl_->physics.step(wrench);
}

std::vector<ContactTruth> Trial::contacts() const {
  std::vector<ContactTruth> contacts;
  impl_->physics.append_contacts(std::llround(state().time_s * 1e9), contacts);
  return contacts;
}

}  // namespace tumble::sim
