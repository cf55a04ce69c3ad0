// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

/// This header is used only within sim. Robots and worlds add elements to a model, which MuJoCo then compiles.
namespace tumble::sim::engine {

/// Composes world and robot in memory (mjSpec) and compiles the model. Outside of tests, only BuiltSituation calls this
/// function. Throws InvalidSituation with the message of MuJoCo's compiler.
World compose(const ResolvedSituation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
