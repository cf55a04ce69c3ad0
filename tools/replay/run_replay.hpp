// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/sweep/run_situation.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// Methods that a replay of a run shows at most: as many as there are colours.
inline constexpr std::size_t kRunReplayMethods = kMethodColours;

/// Indices of the methods of a run that its replay shows, in their order: those that ended with poses or rates and were
/// not given the truth; first the baseline and `tumble` of each kind, then what has poses, then the others.
std::vector<std::size_t> shown_methods(const scenarios::RunResult& run);

/// A draw that has been run, with its truth.
Replay replay_of_run(const scenarios::RunResult& run);

}  // namespace tumble::tools
