// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

enum class Moving { drawn, left_out };

/// Pictures and plots of a draw that has been run: the robot along its path, a film strip, the maps of the baseline and
/// of the method of our own that comes first, coloured by error, its replay, and the plots that its robot and methods
/// give something to; and, when asked for, a moving picture, which costs more than all else. `choice` and `made_of`
/// stay empty. Throws BadInput or std::runtime_error where nothing can be drawn.
Example example_of(const scenarios::RunResult& run, Moving moving);

/// The robot along its path, and the replay: what tells most of a draw on which methods failed, and is cheap enough for
/// many of them. Otherwise as `example_of`.
Example failure_example_of(const scenarios::RunResult& run);

}  // namespace tumble::tools
