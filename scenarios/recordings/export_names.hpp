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

/// Returns names of sensors for exported files and bags. A sensor name gets a number if another sensor has the same
/// name. A sensor name also gets a number if a bag needs the name for a topic or frame: body, clock, tf, tf_static,
/// truth, world, base_link, map or odom.
ExportNames export_names(const sim::Sensors& sensors);
ExportNames export_names(const sim::Truth& truth);

std::string free_name(const std::string& name, std::set<std::string>& taken);

inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
