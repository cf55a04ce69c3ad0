// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

/// A kind of world: its parameters, and its additions to a model that is being composed.
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
/// Drops of a metre and more with ledges between them.
const WorldType& cliff_world();
/// Room with a floor, walls, ceiling, furniture, obstacles and patches of other friction.
const WorldType& floor_world();
/// Such a room with a ramp up, a plateau and a ramp down.
const WorldType& ramp_world();
/// Corridor with doors, niches and pillars.
const WorldType& corridor_world();
/// Lava tube, rough inside.
const WorldType& tube_world();

/// All kinds in the order of registration. A new kind is a file and a line in world_type.cpp.
std::span<const WorldType* const> all_world_types();
/// Throws InvalidSituation for an unknown name, with the nearest known type.
const WorldType& find_world_type(std::string_view name);

}  // namespace tumble::sim
