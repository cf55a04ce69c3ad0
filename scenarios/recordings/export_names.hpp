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

/// A sensor name gets a number if an earlier sensor has the same name, or if the name is a frame or topic of a bag
/// (truth, body, world, tf, map, odom, base_link).
ExportNames export_names(const sim::Sensors& sensors);
ExportNames export_names(const sim::Truth& truth);

std::string free_name(const std::string& name, std::set<std::string>& taken);

inline bool has_timed_points(const sim::LidarRecord& lidar) {
  return lidar.point_times == sim::PointTimes::measured;
}

}  // namespace tumble::scenarios
