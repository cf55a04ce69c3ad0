// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// A kind of world: its parameters, and the function that adds the world to a model under composition.
struct WorldType {
  ComponentType component;
  /// Adds static geoms to `spec` and fills `world` except model and ids. `values` are resolved. Random numbers come
  /// from streams of `seed` named "terrain" or "terrain.*".
  void (*build)(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world);
};

/// Hill: flat top, slope, run-out, relief, rocks, trunks.
const WorldType& hill_world();
/// A flight of steps down a grassy slope.
const WorldType& stairs_world();
/// Drops of a metre and more with ledges between the drops.
const WorldType& cliff_world();
/// Room with a floor, walls, ceiling, furniture, obstacles and floor patches with different friction.
const WorldType& floor_world();
/// Room with a ramp up, a plateau and a ramp down.
const WorldType& ramp_world();
/// Corridor with doors, niches and pillars.
const WorldType& corridor_world();
/// Lava tube, rough inside.
const WorldType& tube_world();

/// Returns all kinds of world in the order of registration. A new kind of world needs a source file and a line in
/// world_type.cpp.
std::span<const WorldType* const> all_world_types();
/// Returns the kind of world with this name. For an unknown name, throws InvalidSituation with the nearest known name.
const WorldType& find_world_type(std::string_view name);

}  // namespace tumble::sim
