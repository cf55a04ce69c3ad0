// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

/// sphere_plots.hpp makes plots like the published figures of the rolling sphere. Each plot shows the truth, and either
/// all attitude methods, or for each source the first position method without truth.
namespace tumble::tools {

/// Plots the path from above, with equal scales on both axes.
Plot sphere_track_plot(const scenarios::RunResult& run);
/// Plots the speed of the centre over time: differences of positions over 50 ms, for truth and estimates. Intervals of
/// true slip and slide are shaded.
Plot sphere_speed_plot(const scenarios::RunResult& run);
/// Plots the height of the centre relative to its start over time.
Plot sphere_height_plot(const scenarios::RunResult& run);
/// Plots the tilt relative to its mean over the longest standstill, in the direction in which the tilt varies most. The
/// plot shows jitter and drift. Without attitude methods or standstill, the plot has no lines.
Plot sphere_standstill_plot(const scenarios::RunResult& run);

}  // namespace tumble::tools
