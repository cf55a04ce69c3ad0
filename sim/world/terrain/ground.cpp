// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/ground.hpp"

namespace tumble::sim {

Ground::Ground(int side, double half_extent_m)
    : side_(side), half_extent_m_(half_extent_m), heights_m_(static_cast<std::size_t>(side) * side) {}

double Ground::height_m(double x_m, double y_m) const {
  const double last = side_ - 1;
  const double u = std::clamp((x_m + half_extent_m_) / cell_m(), 0.0, last);
  const double v = std::clamp((y_m + half_extent_m_) / cell_m(), 0.0, last);
  const int column = std::min(static_cast<int>(u), side_ - 2), row = std::min(static_cast<int>(v), side_ - 2);
  const double a = u - column, b = v - row;
  return (1 - b) * ((1 - a) * node_m(row, column) + a * node_m(row, column + 1)) +
         b * ((1 - a) * node_m(row + 1, column) + a * node_m(row + 1, column + 1));
}

void Ground::add_to(mjSpec* spec, engine::World& world, const std::string& name, const Colour& colour) const {
  add_height_field(spec, world, name, {side_, side_, half_extent_m_, half_extent_m_, heights_m_}, 1.0, 1e-3, colour);
}

double fade(double distance_m, double inner_m, double outer_m) {
  const double u = std::clamp((distance_m - inner_m) / (outer_m - inner_m), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

}  // namespace tumble::sim
