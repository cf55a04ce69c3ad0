// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Of sensors of one kind, in their order.
struct GivenNames {
  std::vector<std::string> names;
  std::vector<std::string> notes;  ///< which sensor has another name than its own, since that was taken
};

/// The names under which a recording's sensors are written, whatever the format: topics, frames, stems of files.
struct ExportNames {
  GivenNames imus, lidars, series;
  std::set<std::string> taken;  ///< these, and the exports' own topics and frames
};

/// Letters, digits, - and _, so that none leads out of a folder; all different, and none of them a topic or a frame
/// that an export has of its own (truth, body, world, tf ...) or that readers take for no sensor's (map, odom,
/// base_link). A sensor keeps its name where nobody before it has that; else, and after all that keep theirs, a number
/// is put behind it. Of a truth the names of the sensors that it is of.
ExportNames export_names(const sim::Sensors& sensors);
ExportNames export_names(const sim::Truth& truth);

/// `name`, or `name`_2, _3 ...: the first that is not taken, which then is.
std::string free_name(const std::string& name, std::set<std::string>& taken);

}  // namespace tumble::scenarios
