// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

Plot sphere_track_plot(const scenarios::RunResult& run);
Plot sphere_speed_plot(const scenarios::RunResult& run);
Plot sphere_height_plot(const scenarios::RunResult& run);
Plot sphere_standstill_plot(const scenarios::RunResult& run);

}  // namespace tumble::tools
