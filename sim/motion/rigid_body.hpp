// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Returns the height of the centre of mass at which the lowest point of a body with attitude `q_WB` is at height
/// `gap_m`.
double clearance_m(const mjModel& model, int body, const Eigen::Quaterniond& q_WB, double gap_m);

Eigen::Matrix3d inertia_W_kg_m2(const mjModel& model, int body, const Eigen::Quaterniond& q_WB);

double raised_cosine(double share);

}  // namespace tumble::sim
