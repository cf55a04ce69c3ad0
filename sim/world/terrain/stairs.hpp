// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/world/geoms.hpp"

namespace tumble::sim {

/// Flight is a straight flight of steps that descends along +x from a level top at height 0.
struct Flight {
  double edge_x_m = 0.0;  ///< x of the edge of the top, where the first riser is
  int steps = 12;         ///< number of risers, at least 1
  double rise_m = 0.17;
  double tread_m = 0.29;
  double half_width_m = 2.0;

  double slope_rad() const;  ///< slope of the line through the edges
  double drop_m() const { return steps * rise_m; }
  double length_m() const { return steps * tread_m; }
};

/// Step is the box of step i = 1 .. steps. The top of step i is i risers below the top of the flight. The last step is
/// level with the ground below the flight.
struct Step {
  Eigen::Vector3d centre_W_m;
  Eigen::Vector3d half_m;
};

/// Returns the steps as boxes that extend `depth_m` below their tops.
std::vector<Step> lay_steps(const Flight& flight, double depth_m);
/// Adds the steps to the world as surfaces "step_1", "step_2" and so on.
void add_steps(mjSpec* spec, engine::World& world, const std::vector<Step>& steps, const Colour& colour);

}  // namespace tumble::sim
