// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/robot_presets.hpp"

namespace tumble::scenarios::presets {

Eigen::Vector3d rig_lever_arm_m() {
  return {-0.022, -0.085, 0.055};
}

}  // namespace tumble::scenarios::presets
