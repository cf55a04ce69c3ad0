// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/scoring/cost.hpp"
#include "scenarios/scoring/families.hpp"

/// Quantities stored in addition to the metrics and shown in the same way.
namespace tumble::scenarios {

std::vector<MetricInfo> cost_quantities() {
  return {
      {"estimate_cpu_s", Unit::s, "CPU time of the estimate alone"},
      {"simulate_cpu_s", Unit::s, "CPU time of the simulation"},
      {"estimate_peak_mib", Unit::mib, "memory at the peak of the estimate, beyond the recording"},
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
      {"motion_moving_s", Unit::s, "time between first and last movement"},
      {"motion_path_m", Unit::m, "length of the path of the centre of mass"},
      {"motion_peak_rate_rad_s", Unit::rad_s, "largest rate"},
      {"motion_peak_accel_m_s2", Unit::m_s2, "largest reading before the rail"},
      {"motion_flight_share", Unit::share, "of the moving time, without contact"},
      {"motion_impacts", Unit::number, "number of onsets"},
      {"motion_clips", Unit::verdict, "1 when any sample of the primary gyro is clipped"},
      {"motion_clipped_share", Unit::share, "of the moving samples, with a clipped gyro axis"},
      {"motion_clipped_samples", Unit::number, "number of those"},
      {"motion_clip_depth_max_rad_s", Unit::rad_s, "largest loss to the rail"},
      {"motion_clip_length_max_s", Unit::s, "longest segment clipped"},
      {"motion_several_axes_share", Unit::share, "of the clipped samples, with two axes or more"},
      {"motion_accel_clipped_share", Unit::share, "of the moving samples, with a clipped accelerometer axis"},
  };
}

}  // namespace tumble::scenarios
