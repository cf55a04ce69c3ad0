// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/impulse.hpp"

#include <cmath>

namespace tumble::sim {

Wrench whole_impulse(const Values& values, double mass_kg, const Eigen::Matrix3d& inertia_W_kg_m2) {
  const double direction = values.at("direction_rad");
  const Eigen::Vector3d forward(std::cos(direction), std::sin(direction), 0.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d spin_W_rad_s = values.at("spin_forward_rad_s") * up.cross(forward) +
                                       values.at("spin_side_rad_s") * forward + values.at("spin_up_rad_s") * up;
  return {mass_kg * (values.at("velocity_m_s") * forward + values.at("lift_m_s") * up), inertia_W_kg_m2 * spin_W_rad_s};
}

}  // namespace tumble::sim
