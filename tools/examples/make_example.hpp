// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

enum class Moving { drawn, left_out };

/// Generates the pictures, plots and replay of a completed run; `choice` and `made_of` stay empty.
Example example_of(const scenarios::RunResult& run, Moving moving);

Example failure_example_of(const scenarios::RunResult& run);

}  // namespace tumble::tools
