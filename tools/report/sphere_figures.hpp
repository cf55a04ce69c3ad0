// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/run_situation.hpp"
#include "tools/report/plots.hpp"
#include "tools/report/summary.hpp"

/// What the published figures of the rolling sphere show, from our draws, the truth beside each curve.
namespace tumble::tools {

/// One draw of a sphere without its lidar, run again with the methods of kinds position and attitude.
struct SphereRoll {
  scenarios::RunResult run;
};

/// Scenarios of the results that are worth a page: slip, slide, bump and plain rolling, as far as they are there.
std::vector<std::string> sphere_scenarios(const Summary& summary);

/// Runs `rolling`, `autogain_fusion` and `tumble` and every attitude method that the results hold for the scenario.
/// Motion and IMU readings are those of the sweep, bit for bit: the lidar, which is left out, draws from streams of its
/// own. Throws what run_situation throws.
SphereRoll make_sphere_roll(const scenarios::DataRoot& data, const Summary& summary, const std::string& scenario,
                            std::uint64_t seed);

/// The way from above, at equal scales.
Figure sphere_track_figure(const SphereRoll& roll);
/// Speed of the centre over time, from differences of position over 50 ms for truth and estimates alike; spells of slip
/// and slide of the truth are shaded.
Figure sphere_speed_figure(const SphereRoll& roll);
/// Height of the centre above where it started, over time.
Figure sphere_height_figure(const SphereRoll& roll);
/// Tilt at standstill against its mean over the longest rest, in the direction in which it varies most: jitter and
/// drift. Without attitude
/// methods or a rest: empty.
Figure sphere_standstill_figure(const SphereRoll& roll);

std::string sphere_html(const std::vector<SphereRoll>& rolls, std::vector<Figure>& figures);

}  // namespace tumble::tools
