// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/model.hpp"

#include <new>

namespace tumble::sim::engine {

World copy_of(const World& world) {
  // The structured binding names all members of World. If World gets a new member, the binding does not compile, so the
  // copy below cannot omit the new member.
  const auto& [model, body, free, surfaces, geoms, patches, half_extent_m, start_W_m, com_offset_m, radius_m] = world;
  ModelPtr own(mj_copyModel(nullptr, model.get()));
  if (!own) throw std::bad_alloc();
  return {std::move(own), body, free, surfaces, geoms, patches, half_extent_m, start_W_m, com_offset_m, radius_m};
}

}  // namespace tumble::sim::engine
