// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <array>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

struct Format {
  const char* name;
  void (*write)(const path& recording, const path& out);
};

void write_csv(const path& recording, const path& out) {
  const sim::Sensors sensors = read_sensors(recording);
  if (!read_info(recording).has_truth) return export_csv(sensors, nullptr, out);
  const sim::Truth truth = read_truth(recording);
  export_csv(sensors, &truth, out);
}

/// Sorted by name.
const std::array<Format, 5> kFormats = {{
    {"csv", write_csv},
    {"kitti", [](const path& recording, const path& out) { export_kitti(read_truth(recording), out); }},
    {"pcd", [](const path& recording, const path& out) { export_pcd(read_sensors(recording), out); }},
    {"ply", [](const path& recording, const path& out) { export_ply(read_sensors(recording), out); }},
    {"tum", [](const path& recording, const path& out) { export_tum(read_truth(recording), out); }},
}};

}  // namespace

std::vector<std::string> export_formats() {
  std::vector<std::string> names;
  for (const Format& format : kFormats) names.emplace_back(format.name);
  return names;
}

void export_recording(const path& recording, const std::string& format, const path& out) {
  for (const Format& each : kFormats) {
    if (format == each.name) return each.write(recording, out);
  }
  std::string known;
  for (const std::string& name : export_formats()) known += " " + name;
  const std::string near = sim::nearest_name(format, export_formats());
  throw BadInput("unknown format '" + format + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                 " (known:" + known + ")");
}

}  // namespace tumble::scenarios
