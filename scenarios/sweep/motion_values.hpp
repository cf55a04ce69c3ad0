// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/sweep/outcome.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns the motion's summary (scenarios/scoring/motion_summary.hpp) as named numbers for the results database.
/// Returns no values for a recording without an IMU. The motion values have the following names and meanings.
///
/// - `motion_moving_s`: time between first and last movement. `motion_path_m`: path length of the centre of mass.
/// - `motion_peak_rate_rad_s`: largest rate. `motion_peak_accel_m_s2`: largest specific force before saturation.
/// - `motion_flight_share`: fraction of the moving time without contact. `motion_impacts`: number of impacts.
/// - `motion_clips`: 1 if any sample of the primary gyro is clipped.
/// - `motion_clipped_share`: fraction of the moving samples with a clipped gyro axis.
/// - `motion_clipped_samples`: number of moving samples with a clipped gyro axis.
/// - `motion_clip_depth_max_rad_s`: largest saturation deficit. `motion_clip_length_max_s`: longest clipped segment.
/// - `motion_several_axes_share`: fraction of the clipped samples with at least two clipped axes; NaN without clipped
///   samples.
/// - `motion_cross_axis_share`: fraction of the clipped samples in which an unclipped axis has a cross-axis error; NaN
///   without clipped samples.
/// - `motion_accel_clipped_share`: fraction of the moving samples with a clipped accelerometer axis.
DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

/// Returns the available motion values of a real recording: `motion_peak_rate_rad_s` of the readings. If reference
/// rates exist, also returns `motion_clips`, `motion_clipped_share`, `motion_clipped_samples` and
/// `motion_clip_depth_max_rad_s` of samples with a known rate.
DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording);

}  // namespace tumble::scenarios
