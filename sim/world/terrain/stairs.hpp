// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/world/geoms.hpp"

namespace tumble::sim {

struct Flight {
  double edge_x_m = 0.0;
  int steps = 12;  ///< number of risers, at least 1
  double rise_m = 0.17;
  double tread_m = 0.29;
  double half_width_m = 2.0;

  double slope_rad() const;  ///< slope of the plane through the edges
  double drop_m() const { return steps * rise_m; }
  double length_m() const { return steps * tread_m; }
};

struct Step {
  Eigen::Vector3d centre_W_m;
  Eigen::Vector3d half_m;
};

std::vector<Step> lay_steps(const Flight& flight, double depth_m);
void add_steps(mjSpec* spec, engine::World& world, const std::vector<Step>& steps, const Colour& colour);

}  // namespace tumble::sim
