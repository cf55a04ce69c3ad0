// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/physics.hpp"

#include <array>
#include <cmath>
#include <new>
#include <sstream>

#include "sim/engine/jointed.hpp"
#include "sim/simulate.hpp"

namespace tumble::sim::engine {

namespace {

constexpr std::array<const char*, mjNWARNING> kWarnings = {
    "singular inertia",       "contact list full",          "constraint list full", "bad number in position",
    "bad number in velocity", "bad number in acceleration", "bad number in control"};

[[noreturn]] void fail(const std::string& reason, double time_s) {
  std::ostringstream text;
  text << reason << " at " << time_s << " s";
  throw SimulationFailure(text.str());
}

Eigen::Vector3d vector(const mjtNum* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

Physics::Physics(World& world)
    : world_(world),
      near_geoms_(*world.model),
      data_(mj_makeData(world.model.get())),
      surface_of_geom_(world.model->ngeom, -1) {
  if (!data_) throw std::bad_alloc();
  if (!world.free) update_bodies(*world.model, *data_);
  for (std::size_t i = 0; i < world.surface_geom.size(); ++i)
    surface_of_geom_[world.surface_geom[i]] = static_cast<int>(i);
  if (!world.patches.empty()) {
    floor_geom_ = mj_name2id(world.model.get(), mjOBJ_GEOM, "floor");
    floor_friction_ = world.model->geom_friction[3 * floor_geom_];
  }
}

BodyState Physics::state() const {
  if (!world_.free) return state_on_joints(*world_.model, *data_, world_.robot_body);
  const mjtNum* q = data_->qpos;
  return {data_->time, vector(q), Eigen::Quaterniond(q[3], q[4], q[5], q[6]), vector(data_->qvel),
          vector(data_->qvel + 3)};
}

void Physics::set_state(const BodyState& state) {
  data_->time = state.time_s;
  if (!world_.free) {
    constexpr double kSame = 1e-9;
    const BodyState now = this->state();
    if ((now.p_WB_m - state.p_WB_m).norm() > kSame || now.q_WB.angularDistance(state.q_WB) > kSame) {
      throw InvalidSituation(
          "motion: the robot is attached by joints, so its pose cannot be set; choose the motion 'swing'");
    }
    return;
  }
  for (int i = 0; i < 3; ++i) {
    data_->qpos[i] = state.p_WB_m[i];
    data_->qvel[i] = state.v_WB_m_s[i];
    data_->qvel[3 + i] = state.w_WB_B_rad_s[i];
    data_->qpos[4 + i] = state.q_WB.vec()[i];
  }
  data_->qpos[3] = state.q_WB.w();
}

void Physics::step(const Wrench& wrench) {
  if (floor_geom_ >= 0) set_floor_friction();
  for (int i = 0; i < 3; ++i) {
    data_->xfrc_applied[6 * world_.robot_body + i] = wrench.force_W_n[i];
    data_->xfrc_applied[6 * world_.robot_body + 3 + i] = wrench.torque_W_nm[i];
  }
  if (world_.free) near_geoms_.around(vector(data_->qpos));
  mj_step(world_.model.get(), data_.get());
  if (!world_.free) update_bodies(*world_.model, *data_);
  check();
}

int Physics::hinge(const std::string& name) const {
  const int joint = mj_name2id(world_.model.get(), mjOBJ_JOINT, name.c_str());
  if (joint < 0 || world_.model->jnt_type[joint] != mjJNT_HINGE) {
    throw InvalidSituation("robot: no hinge '" + name + "'");
  }
  return joint;
}

double Physics::joint_rad(const std::string& name) const {
  return data_->qpos[world_.model->jnt_qposadr[hinge(name)]];
}

double Physics::joint_rate_rad_s(const std::string& name) const {
  return data_->qvel[world_.model->jnt_dofadr[hinge(name)]];
}

void Physics::set_joint(const std::string& name, double angle_rad, double rate_rad_s) {
  const int joint = hinge(name);
  data_->qpos[world_.model->jnt_qposadr[joint]] = angle_rad;
  data_->qvel[world_.model->jnt_dofadr[joint]] = rate_rad_s;
  update_bodies(*world_.model, *data_);
}

void Physics::set_floor_friction() {
  const BodyState now = state();
  const Eigen::Vector3d p_G_m = now.p_WB_m - now.q_WB * world_.com_offset_m;
  double friction = floor_friction_;
  for (const FrictionPatch& patch : world_.patches) {
    if (patch.contains(p_G_m.x(), p_G_m.y())) friction = patch.friction;
  }
  world_.model->geom_friction[3 * floor_geom_] = friction;
}

void Physics::check() const {
  for (int i = 0; i < mjNWARNING; ++i) {
    if (data_->warning[i].number > 0) fail(std::string("engine warning: ") + kWarnings[i], data_->time);
  }
  for (int i = 0; i < world_.model->nq; ++i) {
    if (!std::isfinite(data_->qpos[i])) fail("position is not finite", data_->time);
  }
  constexpr double kBelow_m = 60.0;
  const Eigen::Vector3d p_m = state().p_WB_m;
  if (std::abs(p_m.x()) > world_.half_extent_m || std::abs(p_m.y()) > world_.half_extent_m || p_m.z() < -kBelow_m) {
    fail("the robot left its world", data_->time);
  }
}

void Physics::append_contacts(std::int64_t time_ns, std::vector<ContactTruth>& contacts) const {
  const mjModel* model = world_.model.get();
  const BodyState now = state();
  const Eigen::Vector3d w_W = now.q_WB * now.w_WB_B_rad_s;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.efc_address < 0) continue;  // too far apart for a force
    const bool robot_second = model->geom_bodyid[contact.geom[1]] == world_.robot_body;
    if (!robot_second && model->geom_bodyid[contact.geom[0]] != world_.robot_body) continue;
    mjtNum force[6];
    mj_contactForce(model, data_.get(), i, force);
    ContactTruth truth;
    truth.time_ns = time_ns;
    truth.point_W_m = vector(contact.pos);
    truth.normal_W = (robot_second ? 1.0 : -1.0) * vector(contact.frame);
    const Eigen::Vector3d v_W = now.v_WB_m_s + w_W.cross(truth.point_W_m - now.p_WB_m);
    truth.slip_velocity_W_m_s = v_W - v_W.dot(truth.normal_W) * truth.normal_W;
    truth.normal_force_n = force[0];
    truth.surface_id = surface_of_geom_[contact.geom[robot_second ? 0 : 1]];
    contacts.push_back(truth);
  }
}

}  // namespace tumble::sim::engine
