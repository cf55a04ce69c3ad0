// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/dialects/sensor_facts.hpp"

/// How a published estimator wants its recordings. Private to scenarios/recordings/dialects.
namespace tumble::scenarios {

/// Where it is written that a peer reads so.
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
  bool needs_times = true;   ///< of points
  bool needs_rings = false;  ///< a lidar that scans in rings: no Livox
  bool takes_empty = true;   ///< a sweep without a point; else such are left out
  ReaderNames (*names)(const SensorFacts&) = nullptr;
  SweepLayout (*sweeps)(const SensorFacts&) = nullptr;
  /// The peer's own files, with this recording's sensors; the rest as its authors have it.
  std::vector<ConfigurationFile> (*configuration)(const SensorFacts&, const ReaderNames&) = nullptr;
  std::string run = {};                 ///< how it is started on them
  std::vector<std::string> notes = {};  ///< what its user must know
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

/// All of them.
std::span<const Dialect> all_dialects();

/// Layouts that several share: x y z and an intensity of 0 to 255, all float32, ring uint16, and the time as float32
/// seconds ("time", Velodyne's driver) or uint32 nanoseconds ("t", Ouster's), both since the sweep's start.
SweepLayout velodyne_layout(const SensorFacts&);
SweepLayout ouster_layout(const SensorFacts&);

/// Of FAST-LIO and what came of it: a Livox under its driver's topics as its CustomMsg, any other lidar as a Velodyne.
ReaderNames fast_lio_names(const SensorFacts& facts);
SweepLayout fast_lio_layout(const SensorFacts& facts);

}  // namespace tumble::scenarios
