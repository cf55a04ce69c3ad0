// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/importing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "tools/tumble/arguments.hpp"

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
  require_fitting(options, "recording");
}

void apply_mounting(const Session& session, const ImportOptions& options, sim::Sensors& sensors) {
  if (!sensors.imus.empty()) {
    const sim::ImuRecord stated = imu_sheet(session, options);
    if (!options.device.empty()) complete(stated, sensors.imus.front());
    if (!options.lever_arm_m.empty()) sensors.imus.front().T_BI.translation() = stated.T_BI.translation();
  }
  if (!sensors.lidars.empty() && !options.T_body_lidar.empty())
    sensors.lidars.front().T_BL = sweep_source(session, options, "").reading.device.T_BL;
}

void open_own(const Session& session, OpenRecording& out) {
  require_own_options(out.options);
  const std::string path = out.options.path.string();
  out.format = "recording";
  out.content.info = scenarios::read_info(path);
  out.content.sensors = scenarios::read_sensors(path);
  if (out.content.info.has_truth) out.truth = scenarios::read_truth(path);
  apply_mounting(session, out.options, out.content.sensors);
  out.rotation = scenarios::check_lidar_rotation(path, out.content, scenarios::GyroUnit::rad_s);
  out.content.notes = out.rotation.notes;
  for (std::string& note : scenarios::imu_notes(out.content)) out.content.notes.push_back(std::move(note));
}

}  // namespace

Imported import_recording(const Session& session, const ImportOptions& options, const std::string& format,
                          scenarios::LidarRotationCheck& rotation) {
  if (format == "recording") {
    (void)scenarios::read_info(options.path);  // throws for other HDF5 files
    throw BadInput(options.path.string() + ": this file is already a recording; use the file directly, without import");
  }
  Imported imported = import_format(session, options, format);
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
  out.options.leave_out_topics = true;
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
      return out;
    } catch (const scenarios::RepairableInput& error) {
      if (!set_option(error.repair(), out.options)) throw;
      out.repairs.push_back({error.repair(), error.what()});
    }
  }
}

}  // namespace tumble::tools
