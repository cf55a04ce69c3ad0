// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sim/engine/model.hpp"

namespace tumble::sim::engine {

bool FrictionPatch::contains(double x_m, double y_m) const {
  const double dx = x_m - centre_x_m, dy = y_m - centre_y_m;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return std::abs(c * dx + s * dy) <= half_x_m && std::abs(-s * dx + c * dy) <= half_y_m;
}

}  // namespace tumble::sim::engine
