// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/sweep/outcome.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Computes statistics of a simulated motion (scenarios/scoring/motion_summary.hpp) as named numbers for the results
/// database.
///
/// - `motion_moving_s`: time between first and last movement; `motion_path_m`: path length of the centre of mass
/// - `motion_peak_rate_rad_s`: largest rate; `motion_peak_accel_m_s2`: largest specific force before saturation
/// - `motion_clip_depth_max_rad_s`: largest saturation deficit; `motion_clip_length_max_s`: longest clipping interval
/// - `motion_several_axes_share`: fraction of the clipped samples with at least two clipped axes
/// - `motion_cross_axis_share`: fraction of the clipped samples in which clipping also disturbs an unclipped axis
DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

/// The clipping values `motion_clips`, `motion_clipped_share`, `motion_clipped_samples` and
/// `motion_clip_depth_max_rad_s` need reference rates.
DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

}  // namespace tumble::scenarios
