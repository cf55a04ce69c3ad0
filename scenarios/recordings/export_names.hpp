// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// GivenNames contains the exported names of all sensors of one kind, in order.
struct GivenNames {
  std::vector<std::string> names;
  std::vector<std::string> notes;  ///< notes on sensors that were renamed because of a conflict
};

/// ExportNames contains the names of a recording's sensors in all export formats, for topics, frames and files.
struct ExportNames {
  GivenNames imus, lidars, series;
  std::set<std::string> taken;  ///< names of the sensors, and topics and frames of the export itself
};

/// Returns unique names for the sensors, of letters, digits, - and _, which are safe as file names. The names differ
/// from the topics and frames of the export (truth, body, world, tf …) and from frames that readers reserve (map, odom,
/// base_link). If an earlier sensor has the same name, a number is appended. For a truth, returns the names of the
/// sensors in the truth.
ExportNames export_names(const sim::Sensors& sensors);
ExportNames export_names(const sim::Truth& truth);

/// Returns the first free name of `name`, `name`_2, `name`_3 …, and adds it to `taken`.
std::string free_name(const std::string& name, std::set<std::string>& taken);

}  // namespace tumble::scenarios
