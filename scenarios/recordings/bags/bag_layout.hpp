// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tumble::scenarios {

enum class PointQuantity { x_m, y_m, z_m, intensity, ring, time };

enum class NumberType { uint8, uint16, uint32, float32, float64 };

struct PointColumn {
  std::string name;
  PointQuantity quantity;
  NumberType type;
  double scale = 1.0;     ///< for time: units per ns
  bool absolute = false;  ///< since 1970, not the sweep's start
};

struct SweepLayout {
  /// Fields of a sensor_msgs/PointCloud2, in order and without gaps; time fields are omitted if the points have no
  /// times.
  std::vector<PointColumn> columns;
  bool livox = false;          ///< CustomMsg instead of `columns`
  bool in_time_order = false;  ///< true: points sorted by time
};

SweepLayout own_sweep_layout();
SweepLayout livox_sweep_layout();

struct ReaderNames {
  std::string imu_topic, imu_frame;
  std::string points_topic, lidar_frame;
  std::string body_frame;
  std::string fixed_frame;  ///< parent of the body; empty: none
};

}  // namespace tumble::scenarios
