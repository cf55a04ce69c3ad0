// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/export_for.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/manifest.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

const Dialect& dialect_of(const std::string& peer) {
  std::string known;
  for (const Dialect& dialect : all_dialects()) {
    if (dialect.name == peer) return dialect;
    known += " " + dialect.name;
  }
  const std::string near = sim::nearest_name(peer, peer_dialects());
  throw BadInput(fmt::format("the export target '{}' is unknown{} (known targets:{})", peer,
                             near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near), known));
}

void require_finite(const sim::LidarRecord& lidar, const PointStore& aside) {
  for (std::size_t number = 0; number < lidar.sweep_start_ns.size(); ++number) {
    const sim::LidarRecord sweep = sweep_alone(lidar, &aside, number);
    for (std::size_t k = 0; k < sweep.range_m.size(); ++k) {
      if (sweep.position_L_m[k].allFinite() && std::isfinite(sweep.range_m[k]) && std::isfinite(sweep.intensity[k]))
        continue;
      throw BadInput(fmt::format("point {} of lidar '{}' has a position, range or intensity that is not finite",
                                 lidar.sweep_first[number] + k, lidar.name));
    }
  }
}

void require_fitting(const Dialect& dialect, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                     const SensorFacts& facts) {
  const auto refuse = [&](const std::string& what) {
    throw BadInput(fmt::format("{}; {} cannot read such a recording", what, dialect.name));
  };
  if (!facts.lidar || facts.lidar->points == 0) refuse("the recording has no lidar return");
  if (dialect.needs_imu && (!facts.imu || facts.imu->samples == 0)) refuse("the recording has no IMU reading");
  if (dialect.needs_times && !facts.lidar->timed)
    refuse(fmt::format("the points of lidar '{}' have no time stamps", sensors.lidars.front().name));
  if (dialect.needs_rings && facts.lidar->livox)
    refuse(fmt::format("the lidar '{}' does not scan in rings", facts.lidar->device));
  require_finite(sensors.lidars.front(), points.front());
}

void write_bag(const Dialect& dialect, const sim::Sensors& sensors, const BagWriting& writing, const path& place) {
  using Writer = void (*)(const sim::Sensors&, const BagWriting&, const path&);
  static const std::map<std::string, Writer> writers = {
      {"rosbag1", export_ros1_bag}, {"rosbag2", export_ros2_bag}, {"mcap", export_mcap}};
  writers.at(dialect.bag_format)(sensors, writing, place);
}

std::vector<std::string> leave_out_empty_sweeps(Dialect& dialect, LidarFacts& lidar) {
  const std::size_t empty = lidar.empty_sweeps;
  if (dialect.takes_empty || empty == 0) return {};
  lidar.sweeps -= empty;
  const std::string note =
      fmt::format("the export leaves out {}{} without points, because {} cannot read an empty cloud", empty,
                  empty == 1 ? " sweep" : " sweeps", dialect.name);
  dialect.notes.push_back(note);
  return {note};
}

}  // namespace

std::vector<std::string> peer_dialects() {
  std::vector<std::string> names;
  for (const Dialect& dialect : all_dialects()) names.push_back(dialect.name);
  return names;
}

std::vector<std::string> export_for(const path& recording, const std::string& peer, const path& folder,
                                    bool with_truth) {
  Dialect dialect = dialect_of(peer);
  const RecordingInfo info = read_info(recording);
  const path scratch = scratch_folder_of(folder);
  std::vector<PointStore> points;
  const sim::Sensors sensors = read_sensors(recording, scratch, points);
  SensorFacts facts = facts_of(sensors, &points);
  require_fitting(dialect, sensors, points, facts);
  const std::vector<std::string> notes = leave_out_empty_sweeps(dialect, *facts.lidar);

  OutputFolder output(folder);
  BagWriting writing;
  writing.origin_ns = info.origin_ns;
  writing.points = &points;
  writing.empty_sweeps = dialect.takes_empty;
  writing.names = dialect.names(facts);
  writing.sweeps = dialect.sweeps(facts);
  const std::int64_t origin_ns = export_origin_ns(info.origin_ns);
  write_bag(dialect, sensors, writing, folder / dialect.bag_name);
  if (with_truth) export_tum(read_truth(recording, scratch), folder / "truth.tum", origin_ns);
  std::vector<std::string> configuration;
  for (const ConfigurationFile& file : configuration_of(dialect, facts)) {
    replace_file(folder / file.name, file.text);
    configuration.push_back(file.name);
  }
  replace_file(folder / "manifest.json", manifest_of(dialect, facts, info, origin_ns, configuration, with_truth));
  output.keep();
  return notes;
}

}  // namespace tumble::scenarios
