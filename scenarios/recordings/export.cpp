// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <array>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

struct Format {
  const char* name;
  void (*write)(const path& recording, const path& out, const ExportChoices& choices);
};

void write_csv(const path& recording, const path& out, const ExportChoices&) {
  const sim::Sensors sensors = read_sensors(recording);
  if (!read_info(recording).has_truth) return export_csv(sensors, nullptr, out);
  const sim::Truth truth = read_truth(recording);
  export_csv(sensors, &truth, out);
}

template <void (*kExport)(const sim::Sensors&, const BagWriting&, const path&)>
void write_bag(const path& recording, const path& out, const ExportChoices& choices) {
  const path scratch = scratch_folder_of(out);
  std::optional<StoredTruth> truth;
  if (choices.truth) truth = read_truth(recording, scratch);
  std::vector<PointStore> points;
  const sim::Sensors sensors = read_sensors(recording, scratch, points);
  BagWriting writing{read_info(recording).origin_ns, truth ? &*truth : nullptr};
  writing.sweeps = choices.sweeps;
  writing.points = &points;
  if (choices.more) choices.more(sensors, writing);
  kExport(sensors, writing, out);
}

void write_tum(const path& recording, const path& out, const ExportChoices& choices) {
  export_tum(read_truth(recording, scratch_folder_of(out)), out, 0, choices.frame);
}

void write_kitti(const path& recording, const path& out, const ExportChoices& choices) {
  export_kitti(read_truth(recording), out, choices.frame);
}

template <void (*kExport)(const sim::Sensors&, const path&)>
void write_sensors(const path& recording, const path& out, const ExportChoices&) {
  kExport(read_sensors(recording), out);
}

/// Sorted by name.
const std::array<Format, 9> kFormats = {{
    {"csv", write_csv},
    {"kitti", write_kitti},
    {"mcap", write_bag<export_mcap>},
    {"pcd", write_sensors<export_pcd>},
    {"ply", write_sensors<export_ply>},
    {"rosbag1", write_bag<export_ros1_bag>},
    {"rosbag2", write_bag<export_ros2_bag>},
    {"rosbag2_mcap", write_bag<export_ros2_mcap>},
    {"tum", write_tum},
}};

}  // namespace

std::vector<std::string> export_formats() {
  std::vector<std::string> names;
  for (const Format& format : kFormats) names.emplace_back(format.name);
  return names;
}

bool is_bag_format(const std::string& format) {
  return format == "mcap" || format.starts_with("rosbag");
}

std::string format_of_ending(const path& out) {
  const std::string ending = out.extension().string();
  return ending == ".mcap" ? "mcap" : ending == ".bag" ? "rosbag1" : ending == ".tum" ? "tum" : "";
}

void export_recording(const path& recording, const std::string& format, const path& out, const ExportChoices& choices) {
  for (const Format& each : kFormats) {
    if (format == each.name) return each.write(recording, out, choices);
  }
  std::string known;
  for (const std::string& name : export_formats()) known += " " + name;
  const std::string near = sim::nearest_name(format, export_formats());
  throw BadInput("unknown format '" + format + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                 " (known:" + known + ")");
}

}  // namespace tumble::scenarios
