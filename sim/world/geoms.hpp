// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/parameters.hpp"

namespace tumble::sim {

using Colour = std::array<float, 4>;

/// Adds a geom that is visible to lidars. `size_m` is MuJoCo's size for the geom type (half widths, radius and half
/// height). `yaw_rad` is the rotation about z.
mjsGeom* add_surface(mjSpec* spec, engine::World& world, const std::string& name, mjtGeom type,
                     const Eigen::Vector3d& position_W_m, const Eigen::Vector3d& size_m, double yaw_rad,
                     const Colour& colour);

struct HeightGrid {
  int rows, columns;
  double half_x_m, half_y_m;
  std::span<const double> heights_m;  ///< rows * columns values
};

/// Adds a height field. The difference between the largest and the smallest height is at least `least_span_m`, because
/// MuJoCo requires a height difference.
mjsGeom* add_height_field(mjSpec* spec, engine::World& world, const std::string& name, const HeightGrid& grid,
                          double common_position_m, double least_span_m, const Colour& colour);

void add_mark(mjSpec* spec, const engine::FrictionPatch& patch, const Colour& colour);

void add_daylight(mjSpec* spec);

}  // namespace tumble::sim
