// SPDX-License-Identifier: BSD-3-Clause
#include "sim/built_situation.hpp"

#include <utility>

#include "sim/compose.hpp"

namespace tumble::sim {

struct BuiltSituation::Impl {
  ResolvedSituation situation;
  engine::World world;
};

BuiltSituation::BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models) {
  engine::World world = engine::compose(situation, models);
  impl_ = std::make_shared<const Impl>(Impl{std::move(situation), std::move(world)});
}

const ResolvedSituation& BuiltSituation::situation() const {
  return impl_->situation;
}

const engine::World& BuiltSituation::world() const {
  return impl_->world;
}

}  // namespace tumble::sim
