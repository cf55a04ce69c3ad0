// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

enum class Moving { drawn, left_out };

/// Generates the pictures, plots and replay of a completed run: the robot along its path, a film strip, plots, and two
/// maps coloured by error. The two maps are those of the baseline and of the first method of tumble. Plots without data
/// are left out. An animation is added on request, because an animation costs more than all other parts together. The
/// members `choice` and `made_of` stay empty. Throws BadInput or std::runtime_error if nothing can be rendered.
Example example_of(const scenarios::RunResult& run, Moving moving);

/// Generates only the picture of the robot along its path and the replay: the most informative and fastest parts for a
/// run with failed methods. The errors are those of `example_of`.
Example failure_example_of(const scenarios::RunResult& run);

}  // namespace tumble::tools
