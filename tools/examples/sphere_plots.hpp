// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/sweep/run_situation.hpp"
#include "tools/examples/example.hpp"

/// What the published figures of the rolling sphere show, from our draws, the truth beside each curve: of the methods
/// of kind position that need no truth the first of each origin, and all of kind attitude.
namespace tumble::tools {

/// The path from above, at equal scales.
Plot sphere_track_plot(const scenarios::RunResult& run);
/// Speed of the centre over time, from differences of position over 50 ms for truth and estimates alike; spells of slip
/// and slide of the truth are shaded.
Plot sphere_speed_plot(const scenarios::RunResult& run);
/// Height of the centre above where it started, over time.
Plot sphere_height_plot(const scenarios::RunResult& run);
/// Tilt at standstill against its mean over the longest rest, in the direction in which it varies most: jitter and
/// drift. Without attitude methods or a rest: without lines.
Plot sphere_standstill_plot(const scenarios::RunResult& run);

}  // namespace tumble::tools
