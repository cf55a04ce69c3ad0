// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/sweep/outcome.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// The motion's summary (scenarios/scoring/motion_summary.hpp) as named numbers, for the results database:
///
/// | name | meaning |
/// | --- | --- |
/// | `motion_moving_s`, `motion_path_m` | time between first and last movement; length of the path of the centre of
/// mass | | `motion_peak_rate_rad_s`, `motion_peak_accel_m_s2` | largest rate; largest reading before the rail | |
/// `motion_flight_share` | of the moving time, without contact | | `motion_impacts` | number of onsets | |
/// `motion_clips` | 1 when any sample of the primary gyro is clipped | | `motion_clipped_share` | of the moving
/// samples, with a clipped gyro axis | | `motion_clipped_samples` | number of those | | `motion_clip_depth_max_rad_s`,
/// `motion_clip_length_max_s` | largest loss to the rail, longest segment clipped | | `motion_several_axes_share` | of
/// the clipped samples, with two axes or more; NaN without clipped samples | | `motion_accel_clipped_share` | of the
/// moving samples, with a clipped accelerometer axis |
///
/// No values for a recording without an IMU.
DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

/// What is known of the same of a real recording: `motion_peak_rate_rad_s` of the readings, and, where its reference
/// knows rates, `motion_clips`, `motion_clipped_share`, `motion_clipped_samples`, `motion_clip_depth_max_rad_s` of the
/// samples that it knows.
DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

}  // namespace tumble::scenarios
