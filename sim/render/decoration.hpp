// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

/// Private to sim: what a picture adds to the engine's scene. A full scene is a defect, so callers count first.
namespace tumble::sim {

/// Engine geoms that decorating a view takes at most.
int decoration_size(const engine::World& world, const View& view);

/// Lines 1 m apart over height fields, 0.5 m apart over planes: they show slope and scale.
void add_grid(const engine::World& world, const mjData& data, mjvScene& scene);
/// Paths as connected capsules, clouds as balls (boxes when there are many).
void add_paths(const View& view, mjvScene& scene);
void add_points(const View& view, mjvScene& scene);

}  // namespace tumble::sim
