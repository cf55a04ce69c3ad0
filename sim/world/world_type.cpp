// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_type.hpp"

#include <array>

#include "sim/registry.hpp"

namespace tumble::sim {

std::span<const WorldType* const> all_world_types() {
  static const std::array kTypes = {&hill_world(), &stairs_world(),   &cliff_world(), &floor_world(),
                                    &ramp_world(), &corridor_world(), &tube_world()};
  return kTypes;
}

const WorldType& find_world_type(std::string_view name) {
  return find_entry(all_world_types(), name, "world");
}

}  // namespace tumble::sim
