// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

/// Each plot shows the truth, and either all attitude methods, or for each source the first position method without
/// truth.
namespace tumble::tools {

Plot sphere_track_plot(const scenarios::RunResult& run);
/// The speed is a difference of positions over 50 ms; intervals of true slip and slide are shaded.
Plot sphere_speed_plot(const scenarios::RunResult& run);
Plot sphere_height_plot(const scenarios::RunResult& run);
/// Plots the tilt relative to its mean over the longest standstill, in the direction in which the tilt varies most.
/// Without attitude methods or standstill, the plot has no lines.
Plot sphere_standstill_plot(const scenarios::RunResult& run);

}  // namespace tumble::tools
