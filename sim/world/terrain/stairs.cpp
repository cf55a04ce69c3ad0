// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/stairs.hpp"

#include <cmath>
#include <string>

namespace tumble::sim {

double Flight::slope_rad() const {
  return std::atan2(rise_m, tread_m);
}

std::vector<Step> lay_steps(const Flight& flight, double depth_m) {
  std::vector<Step> steps;
  for (int i = 1; i <= flight.steps; ++i) {
    const double top_m = -i * flight.rise_m;
    steps.push_back({{flight.edge_x_m + (i - 0.5) * flight.tread_m, 0.0, top_m - 0.5 * depth_m},
                     {0.5 * flight.tread_m, flight.half_width_m, 0.5 * depth_m}});
  }
  return steps;
}

void add_steps(mjSpec* spec, engine::World& world, const std::vector<Step>& steps, const Colour& colour) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    add_surface(spec, world, "step_" + std::to_string(i + 1), mjGEOM_BOX, steps[i].centre_W_m, steps[i].half_m, 0.0,
                colour);
  }
}

}  // namespace tumble::sim
