// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Height of the centre of mass at which a body with attitude `q_WB` is `gap_m` above horizontal ground at height 0.
double clearance_m(const mjModel& model, int body, const Eigen::Quaterniond& q_WB, double gap_m);

Eigen::Matrix3d inertia_W_kg_m2(const mjModel& model, int body, const Eigen::Quaterniond& q_WB);

double raised_cosine(double share);

}  // namespace tumble::sim
