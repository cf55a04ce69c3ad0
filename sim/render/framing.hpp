// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/render/renderer.hpp"

namespace tumble::sim {

struct Framing {
  Eigen::Vector3d look_at_W_m;
  double distance_m;
};

Framing frame(const View& view, double robot_radius_m, double fovy_rad);

}  // namespace tumble::sim
