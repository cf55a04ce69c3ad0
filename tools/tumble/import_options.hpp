// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/import.hpp"
#include "tools/tumble/session.hpp"
#include "tools/tumble/verb_options.hpp"

namespace tumble::tools {

struct ImportOptions {
  std::filesystem::path path, out;
  std::string format, robot;
  double radius_m = 0.0;
  std::string device, accel_unit, gyro_unit, columns;
  std::vector<double> lever_arm_m;
  std::filesystem::path imu;
  std::string lidar, stem, bin_columns, time_field, time_unit;
  std::vector<double> T_body_lidar;
  double imu_minus_lidar_clock_s = 0.0;
  std::filesystem::path times;
  double sweep_period_s = 0.0;
  bool not_skewed = false;
  std::filesystem::path reference;
  std::string reference_frame;
  bool sorted = false;
  std::vector<std::string> imu_topics, lidar_topics;
  std::string reference_topic, stamps;
  bool for_odometry = false;  ///< see BagReading
  std::string base_frame;     ///< see BagReading
};

/// Converts X Y Z QX QY QZ QW; no numbers give the identity. Throws BadInput with the name of the option.
Eigen::Isometry3d pose_of(const std::string& option, const std::vector<double>& numbers);

void declare_sensors(VerbOptions& verb, ImportOptions& options);
void declare(VerbOptions& verb, ImportOptions& options);

std::string format_of(const ImportOptions& options);

void require_fitting(const ImportOptions& options, const std::string& format);

sim::ImuRecord imu_sheet(const Session& session, const ImportOptions& options);
void complete(const sim::ImuRecord& sheet, sim::ImuRecord& imu);
scenarios::AccelUnit accel_unit(const ImportOptions& options);
scenarios::GyroUnit gyro_unit(const ImportOptions& options);

scenarios::SweepSource sweep_source(const Session& session, const ImportOptions& options, const std::string& format);
/// Returns the user's choice, or else a file of norlab's mapper next to the sweeps, or truth.csv in a folder of tables;
/// empty if there is no such file.
std::filesystem::path reference_file(const ImportOptions& options, const std::string& format);
/// If the user names no frame and the recording has a lidar, the reference poses are assumed to be those of the lidar.
scenarios::ReferenceSource reference_source(const ImportOptions& options, const std::filesystem::path& file,
                                            bool has_lidar);
scenarios::ReferenceSource trajectory_source(const ImportOptions& options, const std::string& format);

scenarios::BagReading bag_reading(const Session& session, const ImportOptions& options);

const char* point_times_word(sim::PointTimes times);

}  // namespace tumble::tools
