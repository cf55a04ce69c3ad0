// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

/// decoration.hpp adds grid lines, paths and point clouds to a picture's MuJoCo scene. The caller must provide enough
/// geoms in the scene, see decoration_size().
namespace tumble::sim {

/// Returns the maximum number of MuJoCo geoms that the decoration of a view uses.
int decoration_size(const engine::World& world, const View& view);

/// Adds lines 1 m apart over height fields and 0.5 m apart over planes, which show slope and scale.
void add_grid(const engine::World& world, const mjData& data, mjvScene& scene);
/// Adds paths as connected capsules, and clouds as balls (boxes if there are many points).
void add_paths(const View& view, mjvScene& scene);
void add_points(const View& view, mjvScene& scene);

}  // namespace tumble::sim
