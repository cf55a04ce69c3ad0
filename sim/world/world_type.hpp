// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/engine/model.hpp"

namespace tumble::sim {

struct WorldType {
  ComponentType component;
  /// Builds the world. The random numbers come from the random streams "terrain" and "terrain.*" with the seed `seed`.
  void (*build)(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world);
};

const WorldType& hill_world();
const WorldType& stairs_world();
const WorldType& cliff_world();
const WorldType& floor_world();
const WorldType& ramp_world();
const WorldType& corridor_world();
const WorldType& tube_world();

std::span<const WorldType* const> all_world_types();
const WorldType& find_world_type(std::string_view name);

}  // namespace tumble::sim
