// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Height of the centre of mass that puts every touching capsule and sphere of a body, turned by `q_WB`, `gap_m` above
/// a level ground at height 0.
double clearance_m(const mjModel& model, int body, const Eigen::Quaterniond& q_WB, double gap_m);

/// Moment of inertia about the centre of mass in world axes of a body turned by `q_WB` [kg m^2].
Eigen::Matrix3d inertia_W_kg_m2(const mjModel& model, int body, const Eigen::Quaterniond& q_WB);

/// Rate of a pulse of unit integral over [0, 1] that rises and falls as a raised cosine; 0 outside.
double raised_cosine(double share);

}  // namespace tumble::sim
