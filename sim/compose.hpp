// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

/// Private to sim, as the engine is: robots and worlds add to a model that the engine then compiles.
namespace tumble::sim::engine {

/// Composes world and robot in memory (mjSpec) and compiles. The situation's components need not be complete: what they
/// leave out is their default. Throws InvalidSituation with the compiler's message.
World compose(const Situation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
