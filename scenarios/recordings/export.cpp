// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

using ExportNotes = std::vector<std::string>;

ExportNotes joined(ExportNotes first, const ExportNotes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

struct Format {
  const char* name;
  ExportNotes (*write)(const path& recording, const path& out, const ExportChoices& choices);
};

std::int64_t origin_of_export(const path& recording) {
  return export_origin_ns(read_info(recording).origin_ns);
}

ExportNotes write_csv(const path& recording, const path& out, const ExportChoices&) {
  const sim::Sensors sensors = read_sensors(recording);
  std::optional<sim::Truth> truth;
  if (read_info(recording).has_truth) truth = read_truth(recording);
  export_csv(sensors, truth ? &*truth : nullptr, out, origin_of_export(recording));
  ExportNames names = export_names(sensors);
  ExportNotes left_out;
  if (!sensors.lidars.empty())
    left_out.emplace_back("the sweeps of the lidar are left out; export them with --format pcd or --format ply");
  return joined(joined(std::move(names.imus.notes), names.series.notes), left_out);
}

template <void (*kExport)(const sim::Sensors&, const BagWriting&, const path&)>
ExportNotes write_bag(const path& recording, const path& out, const ExportChoices& choices) {
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
  ExportNames names = export_names(sensors);
  ExportNotes left_out;
  for (const sim::SeriesRecord& series : sensors.series)
    left_out.push_back(
        fmt::format("sensor '{}' of kind '{}' is left out, because exported bags contain IMUs, lidars and poses only",
                    series.name, series.kind));
  return joined(joined(std::move(names.imus.notes), names.lidars.notes), left_out);
}

ExportNotes write_tum(const path& recording, const path& out, const ExportChoices& choices) {
  export_tum(read_truth(recording, scratch_folder_of(out)), out, origin_of_export(recording), choices.frame);
  return {};
}

ExportNotes write_kitti(const path& recording, const path& out, const ExportChoices& choices) {
  export_kitti(read_truth(recording), out, choices.frame);
  return {};
}

template <void (*kExport)(const sim::Sensors&, const path&, std::int64_t)>
ExportNotes write_sweeps(const path& recording, const path& out, const ExportChoices&) {
  const sim::Sensors sensors = read_sensors(recording);
  kExport(sensors, out, origin_of_export(recording));
  return export_names(sensors).lidars.notes;
}

const std::array<Format, 9> kFormats = {{
    {"csv", write_csv},
    {"kitti", write_kitti},
    {"mcap", write_bag<export_mcap>},
    {"pcd", write_sweeps<export_pcd>},
    {"ply", write_sweeps<export_ply>},
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

void require_own_kind(const std::string& format, const path& out) {
  static const std::map<std::string, std::set<std::string>> kEndings = {
      {"mcap", {".mcap"}}, {"rosbag1", {".bag"}}, {"tum", {".tum", ".txt"}}, {"kitti", {".txt", ".kitti"}}};
  const auto own = kEndings.find(format);
  const std::string ending = out.extension().string();
  if (own == kEndings.end() || ending.empty() || own->second.contains(ending)) return;
  if (!std::filesystem::is_regular_file(out)) return;
  throw BadInput(fmt::format(
      "{}: the output file exists and has another format than '{}'; choose another output name that ends in {}",
      out.string(), format, fmt::join(own->second, " or ")));
}

ExportNotes export_recording(const path& recording, const std::string& format, const path& out,
                             const ExportChoices& choices) {
  for (const Format& each : kFormats) {
    if (format == each.name) return each.write(recording, out, choices);
  }
  std::string known;
  for (const std::string& name : export_formats()) known += " " + name;
  const std::string near = sim::did_you_mean(format, export_formats());
  throw BadInput(fmt::format("unknown export format '{}'{} (known formats:{})", format,
                             near.empty() ? "" : " (" + near + ")", known));
}

}  // namespace tumble::scenarios
