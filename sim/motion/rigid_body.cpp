// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/rigid_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::sim {

double clearance_m(const mjModel& model, int body, const Eigen::Quaterniond& q_WB, double gap_m) {
  double lowest_m = 0.0;
  for (int geom = model.body_geomadr[body]; geom < model.body_geomadr[body] + model.body_geomnum[body]; ++geom) {
    const bool touches = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    const bool capsule = model.geom_type[geom] == mjGEOM_CAPSULE;
    if (!touches || !(capsule || model.geom_type[geom] == mjGEOM_SPHERE)) continue;
    const mjtNum* q = model.geom_quat + 4 * geom;
    const mjtNum* p = model.geom_pos + 3 * geom;
    const Eigen::Vector3d axis_W = q_WB * (Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitZ());
    const double half_m = capsule ? std::abs(axis_W.z()) * model.geom_size[3 * geom + 1] : 0.0;
    const double centre_m = (q_WB * Eigen::Vector3d(p[0], p[1], p[2])).z();
    lowest_m = std::min(lowest_m, centre_m - half_m - model.geom_size[3 * geom]);
  }
  return gap_m - lowest_m;
}

Eigen::Matrix3d inertia_W_kg_m2(const mjModel& model, int body, const Eigen::Quaterniond& q_WB) {
  const mjtNum* q = model.body_iquat + 4 * body;
  const Eigen::Matrix3d R_Wi = (q_WB * Eigen::Quaterniond(q[0], q[1], q[2], q[3])).toRotationMatrix();
  return R_Wi * Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * body).asDiagonal() * R_Wi.transpose();
}

double raised_cosine(double share) {
  if (!(share > 0.0 && share < 1.0)) return 0.0;
  return 1.0 - std::cos(2.0 * std::numbers::pi * share);
}

}  // namespace tumble::sim
