// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/dialects/sensor_facts.hpp"

/// A dialect is the recording format that a published estimator expects: a bag, and templates of the configuration
/// files.
namespace tumble::scenarios {

struct Source {
  std::string repository, path, commit;
};

struct ConfigurationFile {
  std::string name, text;
};

struct LivoxDialect {
  std::string imu_topic, points_topic, file;
};

struct Dialect {
  std::string name;
  std::string bag_format;  ///< rosbag1, rosbag2 or mcap
  std::string bag_name;    ///< name of the file or folder
  std::string imu_topic, points_topic;
  std::string fixed_frame;  ///< constant parent of base_link in /tf_static; empty: none
  std::optional<LivoxDialect> livox;
  /// The time field of a point counts from the sweep's start: "time" in float32 seconds (Velodyne's driver), or "t" in
  /// uint32 nanoseconds (Ouster's driver).
  std::string point_times;
  bool needs_imu = true;
  bool needs_times = true;
  bool needs_rings = false;  ///< scanning lidar with rings, no Livox
  bool takes_empty = true;   ///< false: sweeps without points are omitted
  std::string run;           ///< starts the published estimator
  std::vector<std::string> notes;
  std::vector<Source> sources;
  std::vector<ConfigurationFile> files;  ///< templates, filled by configuration_of

  ReaderNames names(const SensorFacts& facts) const;
  SweepLayout sweeps(const SensorFacts& facts) const;
};

std::span<const Dialect> all_dialects();

/// Fills the templates of configuration files. A placeholder "@quantity@" becomes a value of the recording's sensors. A
/// placeholder "@quantity|text@" becomes `text` if the value is unknown.
std::vector<ConfigurationFile> configuration_of(const Dialect& dialect, const SensorFacts& facts);

}  // namespace tumble::scenarios
