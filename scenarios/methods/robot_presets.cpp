// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/robot_presets.hpp"

namespace tumble::scenarios::presets {

Eigen::Vector3d rig_lever_arm_m() {
  return {-0.022, -0.085, 0.055};
}

Eigen::AlignedBox3d rig_body_L() {
  return {Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};
}

}  // namespace tumble::scenarios::presets
