// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/jointed.hpp"

#include <Eigen/Cholesky>
#include <new>

#include "sim/simulate.hpp"

namespace tumble::sim::engine {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<const Eigen::Vector3d> position(const mjData& data, int body) {
  return Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * body);
}

Eigen::Quaterniond attitude(const mjData& data, int body) {
  const mjtNum* q = data.xquat + 4 * body;
  return {q[0], q[1], q[2], q[3]};
}

Vector6d missing(const Eigen::Isometry3d& T_WB, const mjData& data, int body) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(T_WB.linear()) * attitude(data, body).conjugate());
  Vector6d out;
  out << T_WB.translation() - position(data, body), turn.angle() * turn.axis();
  return out;
}

}  // namespace

void update_bodies(const mjModel& model, mjData& data) {
  mj_kinematics(&model, &data);
  mj_comPos(&model, &data);
  mj_comVel(&model, &data);
}

BodyState state_on_joints(const mjModel& model, const mjData& data, int body) {
  mjtNum velocity[6];  // angular, then linear, world axes
  mj_objectVelocity(&model, &data, mjOBJ_XBODY, body, velocity, 0);
  BodyState out;
  out.time_s = data.time;
  out.p_WB_m = position(data, body);
  out.q_WB = attitude(data, body);
  out.v_WB_m_s = Eigen::Map<const Eigen::Vector3d>(velocity + 3);
  out.w_WB_B_rad_s = out.q_WB.conjugate() * Eigen::Map<const Eigen::Vector3d>(velocity);
  return out;
}

BodyState state_at_rest(const World& world) {
  const DataPtr data(mj_makeData(world.model.get()));
  if (!data) throw std::bad_alloc();
  update_bodies(*world.model, *data);
  return state_on_joints(*world.model, *data, world.robot_body);
}

void reach(const World& world, const Eigen::Isometry3d& T_WB, mjData& data) {
  constexpr int kSteps = 60;
  constexpr double kDamping = 1e-4, kLongest_rad = 0.5, kNear = 1e-6;
  const mjModel& model = *world.model;
  Jacobian jacobian(6, model.nv);
  Eigen::VectorXd turn(model.nv);
  for (int i = 0; i < kSteps; ++i) {
    mj_kinematics(&model, &data);
    mj_comPos(&model, &data);
    const Vector6d error = missing(T_WB, data, world.robot_body);
    if (!error.allFinite() || error.norm() < kNear) return;
    mj_jacBody(&model, &data, jacobian.data(), jacobian.data() + 3 * model.nv, world.robot_body);
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += kDamping;
    turn = normal.ldlt().solve(jacobian.transpose() * error);
    if (turn.norm() > kLongest_rad) turn *= kLongest_rad / turn.norm();
    mj_integratePos(&model, data.qpos, turn.data(), 1.0);
  }
  mj_kinematics(&model, &data);
}

}  // namespace tumble::sim::engine
