// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// bag_layout.hpp describes the topics, frames and point layout that a reader of bags expects. bag.hpp describes the
/// default.
namespace tumble::scenarios {

/// PointQuantity is the physical quantity of a point field.
enum class PointQuantity { x_m, y_m, z_m, intensity, ring, time };

/// NumberType is the number type of a point field. For integers, values are rounded and limited to the range of the
/// type.
enum class NumberType { uint8, uint16, uint32, float32, float64 };

/// PointColumn describes one field of a point.
struct PointColumn {
  std::string name;
  PointQuantity quantity;
  NumberType type;
  double scale = 1.0;     ///< intensity (0 to 1 in recordings): factor; time: units per ns (1e-9: s)
  bool absolute = false;  ///< time since 1970, instead of since the sweep's start
};

/// SweepLayout describes the message layout of a sweep.
struct SweepLayout {
  /// Fields of a sensor_msgs/PointCloud2, in order, without gaps. Time fields are omitted if the points have no times.
  std::vector<PointColumn> columns;
  bool livox = false;          ///< writes a CustomMsg of Livox drivers, with times in ns, instead of `columns`
  bool in_time_order = false;  ///< true: points sorted by time; false: in the recording's order
};

/// Returns the columns x y z intensity ring time offset_ns: the layout of Velodyne's driver, plus a time in whole
/// nanoseconds.
SweepLayout own_sweep_layout();
/// Returns the layout of Livox drivers' CustomMsg.
SweepLayout livox_sweep_layout();

/// ReaderNames contains the topic and frame names that a reader of one IMU and one lidar expects.
struct ReaderNames {
  std::string imu_topic, imu_frame;
  std::string points_topic, lidar_frame;
  std::string body_frame;
  std::string fixed_frame;  ///< parent frame of the body in /tf_static; empty: none
};

}  // namespace tumble::scenarios
