// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

/// Private to sim, as the engine is: robots and worlds add to a model that the engine then compiles.
namespace tumble::sim::engine {

/// Composes world and robot in memory (mjSpec) and compiles: the work of a BuiltSituation, which alone calls it outside
/// of tests. Throws InvalidSituation with the compiler's message.
World compose(const ResolvedSituation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
