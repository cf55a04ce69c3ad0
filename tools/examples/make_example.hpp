// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

enum class Moving { drawn, left_out };

/// Generates the pictures, plots and replay of a completed run. The pictures show the robot along its path, a film
/// strip, and the maps of the baseline and of the first method of tumble, coloured by error. Plots without data are
/// omitted. The animation is optional, because it costs more than the rest. `choice` and `made_of` stay empty. Throws
/// BadInput or std::runtime_error if nothing can be rendered.
Example example_of(const scenarios::RunResult& run, Moving moving);

/// Generates only the picture of the robot along its path and the replay: the most informative and fastest parts, for a
/// run with failed methods. Throws like `example_of`.
Example failure_example_of(const scenarios::RunResult& run);

}  // namespace tumble::tools
