// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// WorldType is a kind of world: its parameters, and the function that adds it to a model.
struct WorldType {
  ComponentType component;
  /// Adds static geoms to `spec`, and fills in `world` except model and ids. The parameters `values` are resolved.
  /// Random numbers come from streams of `seed` named "terrain" or "terrain.*".
  void (*build)(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world);
};

/// Returns the world type hill: flat top, slope, run-out, relief, rocks, trunks.
const WorldType& hill_world();
/// Returns the world type stairs: a flight of steps down a grassy slope.
const WorldType& stairs_world();
/// Returns the world type cliff: drops of a metre and more with ledges between the drops.
const WorldType& cliff_world();
/// Returns the world type floor: a room with walls, ceiling, furniture, obstacles and floor patches with different
/// friction.
const WorldType& floor_world();
/// Returns the world type ramp: a room with a ramp up, a plateau and a ramp down.
const WorldType& ramp_world();
/// Returns the world type corridor, with doors, niches and pillars.
const WorldType& corridor_world();
/// Returns the world type tube: a lava tube that is rough inside.
const WorldType& tube_world();

/// Returns all world types in the order of registration. A new world type needs a source file and a line in
/// world_type.cpp.
std::span<const WorldType* const> all_world_types();
/// Returns the world type with this name. For an unknown name, throws InvalidSituation with the nearest known name.
const WorldType& find_world_type(std::string_view name);

}  // namespace tumble::sim
