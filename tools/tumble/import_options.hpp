// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/import.hpp"
#include "tools/tumble/session.hpp"
#include "tools/tumble/verb_options.hpp"

/// The options of `tumble import`, and what they mean to the library. All throw BadInput with one clear line.
namespace tumble::tools {

struct ImportOptions {
  std::filesystem::path path, out;
  std::string format, robot;
  double radius_m = 0.0;
  // of the IMU
  std::string device, accel_unit, gyro_unit;
  std::vector<double> lever_arm_m;
  std::filesystem::path imu;
  // of the lidar
  std::string lidar, stem, bin_columns, time_field, time_unit;
  std::vector<double> T_body_lidar;
  std::filesystem::path times;
  double sweep_period_s = 0.0;
  bool not_skewed = false;
  // of the reference
  std::filesystem::path reference;
  std::string reference_frame;
  bool sorted = false, align_reference = false;
  // of a bag
  std::vector<std::string> imu_topics, lidar_topics;
  std::string reference_topic, stamps;
};

void declare(VerbOptions& verb, ImportOptions& options);

/// The format that is asked for, or that the path's ending or content tells.
std::string format_of(const ImportOptions& options);

/// Refuses an option that has no meaning for the format.
void require_fitting(const ImportOptions& options, const std::string& format);

/// Name, device, ranges, noise and place of an IMU, from its data sheet and the options.
sim::ImuRecord imu_sheet(const Session& session, const ImportOptions& options);
/// What a file states less than the data sheet is completed from it.
void complete(const sim::ImuRecord& sheet, sim::ImuRecord& imu);
scenarios::AccelUnit accel_unit(const ImportOptions& options);
scenarios::GyroUnit gyro_unit(const ImportOptions& options);

scenarios::SweepSource sweep_source(const Session& session, const ImportOptions& options, const std::string& format);
/// The file of reference poses that is asked for, or lies beside sweeps as norlab's mapper writes them; "": none.
std::filesystem::path reference_file(const ImportOptions& options, const std::string& format);
/// Poses are of the lidar where the recording has one and nothing else is said.
scenarios::ReferenceSource reference_source(const ImportOptions& options, const std::filesystem::path& file,
                                            bool has_lidar);
scenarios::ReferenceSource trajectory_source(const ImportOptions& options, const std::string& format);

scenarios::BagReading bag_reading(const Session& session, const ImportOptions& options);

const char* point_times_word(sim::PointTimes times);

}  // namespace tumble::tools
