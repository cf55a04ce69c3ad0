// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

struct GivenNames {
  std::vector<std::string> names;
  std::vector<std::string> notes;
};

struct ExportNames {
  GivenNames imus, lidars, series;
  std::set<std::string> taken;  ///< names of sensors, topics and frames
};

/// export_names() appends a number to a sensor name that another sensor already has. The names of topics and frames of
/// a bag also get a number: body, clock, tf, tf_static, truth, world, base_link, map, odom.
ExportNames export_names(const sim::Sensors& sensors);
ExportNames export_names(const sim::Truth& truth);

std::string free_name(const std::string& name, std::set<std::string>& taken);

inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
