// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// The header bag_layout.hpp describes the topics, frames and point layout that a reader of bags expects. The default
/// layout is the layout in bag.hpp.
namespace tumble::scenarios {

/// PointQuantity is the physical quantity of a point field.
enum class PointQuantity { x_m, y_m, z_m, intensity, ring, time };

/// NumberType is the number type of a point field. Values for integer fields are rounded and limited to the range of
/// the type.
enum class NumberType { uint8, uint16, uint32, float32, float64 };

/// PointColumn describes one field of a point.
struct PointColumn {
  std::string name;
  PointQuantity quantity;
  NumberType type;
  double scale = 1.0;     ///< for intensity (0 to 1 in recordings): factor; for time: units per ns (1e-9: s)
  bool absolute = false;  ///< time counts from 1970 instead of from the sweep's start in the header
};

/// SweepLayout describes the message layout of a sweep.
struct SweepLayout {
  /// The list `columns` contains the fields of a sensor_msgs/PointCloud2, in order, without gaps. The time fields are
  /// omitted if the points have no times.
  std::vector<PointColumn> columns;
  bool livox = false;          ///< writes a CustomMsg of Livox drivers, with times in ns, and ignores `columns`
  bool in_time_order = false;  ///< sorts points by time; else points keep the recording's order
};

/// Returns the columns x y z intensity ring time offset_ns: the layout of Velodyne's driver, plus a time in whole
/// nanoseconds.
SweepLayout own_sweep_layout();
/// Returns the layout of Livox drivers' CustomMsg.
SweepLayout livox_sweep_layout();

/// ReaderNames contains the topic and frame names that a reader for one IMU and one lidar expects. The names in
/// ReaderNames belong to the first IMU and the first lidar.
struct ReaderNames {
  std::string imu_topic, imu_frame;
  std::string points_topic, lidar_frame;
  std::string body_frame;
  std::string fixed_frame;  ///< parent of the body in /tf_static; "": none
};

}  // namespace tumble::scenarios
