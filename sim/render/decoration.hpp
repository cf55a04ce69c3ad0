// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

namespace tumble::sim {

int decoration_size(const engine::World& world, const View& view);

void add_grid(const engine::World& world, const mjData& data, mjvScene& scene);
void add_paths(const View& view, mjvScene& scene);
void add_points(const View& view, mjvScene& scene);
/// Writes the names of the paths over a rendered picture. The background of each name has the colour of the path.
void add_legend(const View& view, const mjrRect& area, const mjrContext& context);

}  // namespace tumble::sim
