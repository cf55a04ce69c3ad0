// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/scoring/cost.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

std::vector<MetricInfo> cost_quantities() {
  return {
      {"estimate_cpu_s", Unit::s, "CPU time of the estimation, without the time for reading and scoring"},
      {"simulate_cpu_s", Unit::s, "CPU time of the simulation"},
      {"estimate_peak_mib", Unit::mib, "peak memory of the estimation, in addition to the memory of the recording"},
  };
}

const MetricInfo& estimate_cost() {
  static const MetricInfo cost = cost_quantities().front();
  return cost;
}

bool is_cost(std::string_view name) {
  static const std::vector<MetricInfo> costs = cost_quantities();
  return std::any_of(costs.begin(), costs.end(), [&](const MetricInfo& cost) { return cost.name == name; });
}

std::vector<MetricInfo> motion_quantities() {
  return {
      {"motion_duration_s", Unit::s, "duration of the recording"},
      {"motion_moving_s", Unit::s, "time between first and last motion"},
      {"motion_path_m", Unit::m, "path length of the centre of mass"},
      {"motion_peak_rate_rad_s", Unit::rad_s, "largest angular velocity"},
      {"motion_peak_accel_m_s2", Unit::m_s2, "maximum true specific force at the IMU"},
      {"motion_flight_share", Unit::share, "share of the motion time without contact"},
      {"motion_impacts", Unit::number, "number of impacts"},
      {"motion_clips", Unit::verdict, "1 if any sample of the primary gyro is clipped, otherwise 0"},
      {"motion_clipped_share", Unit::share, "share of the samples in motion with a clipped gyro axis"},
      {"motion_clipped_samples", Unit::number, "number of samples in motion with a clipped gyro axis"},
      {"motion_clip_depth_max_rad_s", Unit::rad_s,
       "maximum saturation deficit of a gyro axis (true rate minus clipped reading)"},
      {"motion_clip_length_max_s", Unit::s, "duration of the longest segment of clipped samples"},
      {"motion_several_axes_share", Unit::share, "share of the clipped samples with at least two clipped axes"},
      {"motion_cross_axis_share", Unit::share,
       "share of the clipped samples in which the clipping of one axis causes an error on an unclipped axis "
       "(cross-axis error)"},
      {"motion_accel_clipped_share", Unit::share, "share of the samples in motion with a clipped accelerometer axis"},
  };
}

}  // namespace tumble::scenarios
