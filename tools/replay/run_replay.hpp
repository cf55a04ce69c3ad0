// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/sweep/evaluate.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/replay/replay.hpp"

namespace tumble::tools {

inline constexpr std::size_t kRunReplayMethods = kMethodColours;

std::vector<std::size_t> shown_methods(const scenarios::RunResult& run);

Replay replay_of_run(const scenarios::RunResult& run);

}  // namespace tumble::tools
