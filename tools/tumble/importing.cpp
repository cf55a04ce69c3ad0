// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/importing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/regular_file.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/import_options.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;
using scenarios::Imported;

Imported imu_table(const Session& session, const ImportOptions& options, const std::filesystem::path& file) {
  return scenarios::import_imu_csv(file, imu_sheet(session, options), accel_unit(options), gyro_unit(options),
                                   options.columns);
}

Imported import_format(const Session& session, const ImportOptions& options, const std::string& format) {
  if (format == "csv" && std::filesystem::is_directory(options.path))
    return scenarios::import_csv_folder(options.path, imu_sheet(session, options), accel_unit(options),
                                        gyro_unit(options));
  if (format == "csv") return imu_table(session, options, options.path);
  if (format == "rosbag1") return scenarios::import_ros1_bag(options.path, bag_reading(session, options));
  if (format == "rosbag2") return scenarios::import_ros2_bag(options.path, bag_reading(session, options));
  if (format == "mcap") return scenarios::import_mcap(options.path, bag_reading(session, options));
  if (format == "tum" || format == "odometry" || (format == "kitti" && !std::filesystem::is_directory(options.path)))
    return scenarios::import_trajectory(trajectory_source(options, format));
  return scenarios::import_sweeps(sweep_source(session, options, format));
}

void say_what_is_assumed(const ImportOptions& options, const std::string& format, std::vector<std::string>& notes) {
  if (options.lever_arm_m.empty() && (format == "csv" || !options.imu.empty())) {
    notes.push_back(
        "--lever-arm is missing, so the program assumes that the IMU is at the robot's centre of mass. Estimated rates "
        "beyond saturation depend on the lever arm");
  }
}

bool set_option(const scenarios::ImportOption& option, ImportOptions& options) {
  const std::pair<const char*, std::string*> known[] = {
      {"--accel-unit", &options.accel_unit}, {"--gyro-unit", &options.gyro_unit}, {"--stamps", &options.stamps}};
  for (const auto& [name, value] : known) {
    if (option.name != name || !value->empty()) continue;
    *value = option.value;
    return true;
  }
  return false;
}

void require_own_options(ImportOptions options) {
  for (std::string* name : {&options.device, &options.lidar}) name->clear();
  for (std::vector<double>* pose : {&options.lever_arm_m, &options.T_body_lidar}) pose->clear();
  options.imu_minus_lidar_clock_s = 0.0;
  require_fitting(options, "recording");
}

void apply_mounting(const Session& session, const ImportOptions& options, Imported& recording) {
  sim::Sensors& sensors = recording.sensors;
  if (!sensors.imus.empty()) {
    const sim::ImuRecord stated = imu_sheet(session, options);
    if (!options.device.empty()) complete(stated, sensors.imus.front());
    if (!options.lever_arm_m.empty()) sensors.imus.front().T_BI.translation() = stated.T_BI.translation();
  }
  if (!sensors.lidars.empty() && !options.T_body_lidar.empty())
    sensors.lidars.front().T_BL = sweep_source(session, options, "").reading.device.T_BL;
  scenarios::correct_lidar_clock(options.imu_minus_lidar_clock_s, recording);
}

void open_own(const Session& session, OpenRecording& out) {
  require_own_options(out.options);
  const std::string path = out.options.path.string();
  out.format = "recording";
  out.content.info = scenarios::read_info(path);
  out.content.sensors = scenarios::read_sensors(path);
  if (out.content.info.has_truth) out.truth = scenarios::read_truth(path);
  out.digest = scenarios::digest(out.content.sensors, nullptr);
  apply_mounting(session, out.options, out.content);
  out.rotation = scenarios::check_lidar_rotation(path, out.content, scenarios::GyroUnit::rad_s);
  out.content.notes = out.rotation.notes;
  for (std::string& note : scenarios::imu_notes(out.content)) out.content.notes.push_back(std::move(note));
}

/// In `tumble odometry`, the sensors of a bag have the names of their topics; `tumble import` shortens these names.
std::string digest_as_stored(sim::Sensors& sensors) {
  std::vector<std::pair<std::string*, std::string>> names;
  const auto shorten = [&](std::string& name) {
    names.emplace_back(&name, name);
    name = scenarios::sensor_name(name);
  };
  for (sim::ImuRecord& imu : sensors.imus) shorten(imu.name);
  for (sim::LidarRecord& lidar : sensors.lidars) shorten(lidar.name);
  std::string digest = scenarios::digest(sensors, nullptr);
  for (auto& [name, topic] : names) *name = std::move(topic);
  return digest;
}

}  // namespace

Imported import_recording(const Session& session, const ImportOptions& options, const std::string& format,
                          scenarios::LidarRotationCheck& rotation) {
  if (format == "recording") {
    (void)scenarios::read_info(options.path);  // throws for other HDF5 files
    throw BadInput(options.path.string() + ": this file is already a recording; use the file directly, without import");
  }
  Imported imported = import_format(session, options, format);
  scenarios::correct_lidar_clock(options.imu_minus_lidar_clock_s, imported);
  if (!options.imu.empty()) {
    scenarios::attach_imus(imported, imu_table(session, options, options.imu));
  }
  if (const std::filesystem::path file = reference_file(options, format); !file.empty()) {
    scenarios::attach_reference(imported, reference_source(options, file, !imported.sensors.lidars.empty()));
    if (options.reference.empty())
      imported.notes.push_back(
          fmt::format("the reference poses come from {} in the imported folder", file.filename().string()));
  }
  rotation = scenarios::check_lidar_rotation(options.path.string(), imported, gyro_unit(options));
  imported.notes.insert(imported.notes.end(), rotation.notes.begin(), rotation.notes.end());
  for (std::string& note : scenarios::imu_notes(imported)) imported.notes.push_back(std::move(note));
  say_what_is_assumed(options, format, imported.notes);
  return imported;
}

OpenRecording open_recording(const Session& session, ImportOptions options) {
  OpenRecording out;
  out.options = std::move(options);
  out.options.for_odometry = true;
  out.format = format_of(out.options);
  if (out.format == "recording") {
    open_own(session, out);
    return out;
  }
  require_fitting(out.options, out.format);
  while (true) {
    try {
      out.content = import_recording(session, out.options, out.format, out.rotation);
      out.truth = std::exchange(out.content.reference, std::nullopt);
      out.digest = digest_as_stored(out.content.sensors);
      return out;
    } catch (const scenarios::RepairableInput& error) {
      if (!set_option(error.repair(), out.options)) throw;
      out.repairs.push_back({error.repair(), error.what()});
    }
  }
}

namespace {

using scenarios::BadInput;

const std::vector<std::string> kFormats = {"csv", "kitti",   "mcap",    "pcd", "odometry",
                                           "ply", "rosbag1", "rosbag2", "tum", "vtk"};

std::string format_of_folder(const std::filesystem::path& folder) {
  const std::map<std::string, std::string> known = {{".ply", "ply"},    {".pcd", "pcd"},     {".bin", "kitti"},
                                                    {".vtk", "vtk"},    {".bag", "rosbag1"}, {".mcap", "rosbag2"},
                                                    {".db3", "rosbag2"}};
  if (std::filesystem::exists(folder / "metadata.yaml")) return "rosbag2";
  std::string found;
  bool tables = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string ending = scenarios::lower_extension(entry.path());
    tables = tables || ending == ".csv";
    const auto format = known.find(ending);
    if (format == known.end() || format->second == found) continue;
    if (!found.empty()) {
      throw BadInput(
          fmt::format("{}: this folder contains files of the formats {} and {}; select one format with --format",
                      folder.string(), found, format->second));
    }
    found = format->second;
  }
  if (found.empty() && std::filesystem::exists(folder / "recording.h5"))
    throw BadInput(
        fmt::format("{}: this folder is an output of 'tumble run'; give the recording in the folder instead: {}",
                    folder.string(), (folder / "recording.h5").string()));
  if (found.empty() && tables) return "csv";
  if (found.empty())
    throw BadInput(fmt::format("{}: this folder contains no .ply, .pcd, .vtk, .bin, .bag, .mcap, .db3 or .csv file",
                               folder.string()));
  return found;
}

/// The Python package, and not `tumble import`, reads the tables of known data sets.
void require_no_data_set(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const bool repoimu = line.find(";Vicon Orientation;") != std::string::npos;
  if (!repoimu && line.find("raw_angular_rate_x_deg_per_s") == std::string::npos) return;
  throw BadInput(
      fmt::format("{}: this is a file of {}; convert it with the Python package: tumble.write(\"out.h5\", "
                  "tumble.{}(\"{}\"))",
                  file.string(), repoimu ? "RepoIMU" : "AirbrakesV2", repoimu ? "read_repoimu" : "read_airbrakes",
                  file.filename().string()));
}

std::string format_of_csv(const std::filesystem::path& file) {
  require_no_data_set(file);
  try {
    return scenarios::pose_format(file);
  } catch (const BadInput&) {
    return "csv";  // no table of poses
  }
}

std::string format_of_content(const std::filesystem::path& file) {
  std::array<char, 16> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  const std::string_view start(first.data(), first.size());
  if (start.starts_with("#ROSBAG V")) return "rosbag1";
  if (start.starts_with("\x89MCAP")) return "mcap";
  if (start.starts_with("SQLite format 3")) return "rosbag2";
  return start.starts_with("\x89HDF\r\n") ? "recording" : "";
}

std::string format_of_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) &&
         (line.find_first_not_of(" \t\r") == std::string::npos || scenarios::is_comment(line)))
    continue;
  return line.find_first_of(",;\t") == std::string::npos ? scenarios::pose_format(file) : format_of_csv(file);
}

}  // namespace

std::string format_of(const ImportOptions& options) {
  if (!options.format.empty()) require_known("format", options.format, kFormats);
  std::error_code error;
  const bool folder = std::filesystem::is_directory(options.path, error);
  // A pipe can be read only once, so it is not opened here.
  if (!folder && options.format != "tum" && std::filesystem::exists(options.path, error))
    scenarios::require_regular_file(options.path);
  if (!options.format.empty()) return options.format;
  if (folder) return format_of_folder(options.path);
  const std::string ending = scenarios::lower_extension(options.path);
  const bool exists = std::filesystem::exists(options.path, error);
  if (const std::string content = exists ? format_of_content(options.path) : ""; !content.empty()) return content;
  if (!options.columns.empty() && options.imu.empty()) return "csv";
  if (ending == ".csv") return format_of_csv(options.path);
  if (ending == ".bag") return "rosbag1";
  if (ending == ".db3" || ending == ".zstd") return "rosbag2";
  if (ending == ".mcap") return "mcap";
  if (ending == ".hdf5" || ending == ".h5") return "recording";
  if (exists && (ending.empty() || ending == ".txt")) return format_of_text(options.path);
  if (ending == ".tum" || ending == ".txt" || ending == ".kitti") return scenarios::pose_format(options.path);
  if (!exists) throw BadInput(options.path.string() + ": the file does not exist");
  throw BadInput(fmt::format(
      "{}: the file name does not reveal the format; give --format (csv, kitti, mcap, rosbag1, rosbag2 or tum)",
      options.path.string()));
}

}  // namespace tumble::tools
