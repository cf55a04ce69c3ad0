// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/render/renderer.hpp"

namespace tumble::sim {

/// Framing is the camera pose in the form of MuJoCo's free camera.
struct Framing {
  Eigen::Vector3d look_at_W_m;
  double distance_m;
};

/// Returns the camera pose that the view states, or a camera pose that shows all paths and robots of the view.
/// `robot_radius_m` is the space around a robot's origin; `fovy_rad` is the vertical field of view.
Framing frame(const View& view, double robot_radius_m, double fovy_rad);

}  // namespace tumble::sim
