// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

/// compose.hpp combines a world and a robot to one model description, which MuJoCo compiles.
namespace tumble::sim::engine {

/// Composes world and robot in memory (mjSpec), and compiles them to one model. Only BuiltSituation and tests call
/// compose(). Throws InvalidSituation with the message of MuJoCo's model compiler.
World compose(const ResolvedSituation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
