// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/dialects/sensor_facts.hpp"

/// The header dialect.hpp describes recording formats that published estimators expect.
namespace tumble::scenarios {

/// Source is a reference that documents the recording format.
struct Source {
  std::string repository, path, commit;
};

struct ConfigurationFile {
  std::string name, text;
};

struct Dialect {
  std::string name;
  std::string bag_format;  ///< rosbag1, rosbag2 or mcap
  std::string bag_name;    ///< of the file or folder
  bool needs_imu = true;
  bool needs_times = true;   ///< needs times of points
  bool needs_rings = false;  ///< needs a scanning lidar with rings, not a Livox
  bool takes_empty = true;   ///< accepts sweeps without points; else empty sweeps are omitted
  ReaderNames (*names)(const SensorFacts&) = nullptr;
  SweepLayout (*sweeps)(const SensorFacts&) = nullptr;
  /// Returns configuration files for the published estimator, with the properties of this recording's sensors. All
  /// other values in the configuration files are those of the estimator's authors.
  std::vector<ConfigurationFile> (*configuration)(const SensorFacts&, const ReaderNames&) = nullptr;
  std::string run = {};                 ///< command that starts the published estimator on these files
  std::vector<std::string> notes = {};  ///< remarks for the user
  std::vector<Source> sources = {};
};

Dialect point_lio_dialect();
Dialect fast_lio_dialect();
Dialect dlio_dialect();
Dialect lio_sam_dialect();
Dialect glim_dialect();
Dialect kiss_icp_dialect();
Dialect rko_lio_dialect();
Dialect norlab_dialect();

std::span<const Dialect> all_dialects();

/// Returns a point layout with x y z and an intensity of 0 to 255 (float32), the ring (uint16), and the time since the
/// sweep's start. The time field is in float32 seconds ("time", Velodyne's driver) or uint32 nanoseconds ("t", Ouster's
/// driver).
SweepLayout velodyne_layout(const SensorFacts&);
SweepLayout ouster_layout(const SensorFacts&);

/// Returns the names or the sweep layout for FAST-LIO and its derivatives. A Livox lidar has the topics and the message
/// CustomMsg of its driver. Any other lidar has the topics of a Velodyne lidar.
ReaderNames fast_lio_names(const SensorFacts& facts);
SweepLayout fast_lio_layout(const SensorFacts& facts);

}  // namespace tumble::scenarios
