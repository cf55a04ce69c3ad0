// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

/// Used only within sim: robots and worlds add elements to a model, which the engine then compiles.
namespace tumble::sim::engine {

/// Composes world and robot in memory (mjSpec) and compiles the model. Outside of tests, only BuiltSituation calls this
/// function. Throws InvalidSituation with the compiler's message.
World compose(const ResolvedSituation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
