// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/dialects/sensor_facts.hpp"

/// The header dialect.hpp describes recording formats that published estimators expect. Each file NAME.yaml of this
/// folder contains one dialect: the bag, and templates of the configuration files.
namespace tumble::scenarios {

/// Source is a reference that documents the recording format.
struct Source {
  std::string repository, path, commit;
};

struct ConfigurationFile {
  std::string name, text;
};

/// LivoxDialect replaces topics and configuration file if the recording has a Livox lidar, whose driver publishes the
/// message CustomMsg.
struct LivoxDialect {
  std::string imu_topic, points_topic, file;
};

struct Dialect {
  std::string name;
  std::string bag_format;  ///< rosbag1, rosbag2 or mcap
  std::string bag_name;    ///< of the file or folder
  std::string imu_topic, points_topic;
  std::string fixed_frame;  ///< constant parent of base_link in /tf_static; "": none
  std::optional<LivoxDialect> livox;
  /// Name of the time field, relative to the sweep's start: "time" in float32 seconds (Velodyne's driver), or "t" in
  /// uint32 nanoseconds (Ouster's driver). The other fields are x y z, an intensity of 0 to 255 (float32), and the ring
  /// (uint16).
  std::string point_times;
  bool needs_imu = true;
  bool needs_times = true;   ///< needs times of points
  bool needs_rings = false;  ///< needs a scanning lidar with rings, not a Livox
  bool takes_empty = true;   ///< accepts sweeps without points; else empty sweeps are omitted
  std::string run;           ///< command that starts the published estimator on these files
  std::vector<std::string> notes;
  std::vector<Source> sources;
  std::vector<ConfigurationFile> files;  ///< with placeholders (configuration_of)

  ReaderNames names(const SensorFacts& facts) const;
  SweepLayout sweeps(const SensorFacts& facts) const;
};

std::span<const Dialect> all_dialects();

/// Returns the configuration files for the published estimator. Each placeholder "@quantity@" of a template becomes the
/// value of this recording's sensors; "@quantity|text@" becomes `text` if the value is 0, which means unknown. All
/// other values are those of the estimator's authors. Throws std::logic_error for an unknown quantity.
std::vector<ConfigurationFile> configuration_of(const Dialect& dialect, const SensorFacts& facts);

}  // namespace tumble::scenarios
