// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Where a reader looks for what in a bag, and how it wants its points. The default is ours (bag.hpp).
namespace tumble::scenarios {

/// What a number of a point says.
enum class PointQuantity { x_m, y_m, z_m, intensity, ring, time };

/// How it is written. Whole numbers are rounded, and held within the type.
enum class NumberType { uint8, uint16, uint32, float32, float64 };

/// One field of a point.
struct PointColumn {
  std::string name;
  PointQuantity quantity;
  NumberType type;
  double scale = 1.0;     ///< of the intensity, which is 0 to 1 here; of a time: its units in a nanosecond (1e-9: s)
  bool absolute = false;  ///< a time counts from 1970, not from the sweep's start, which the header states
};

/// What a sweep becomes.
struct SweepLayout {
  /// Fields of a sensor_msgs/PointCloud2, in order, without gaps; times are left out where points have none.
  std::vector<PointColumn> columns;
  bool livox = false;          ///< a CustomMsg of Livox' drivers instead, of times in ns: `columns` do not count
  bool in_time_order = false;  ///< points stand in the order of their times; else as the recording has them
};

/// x y z intensity ring time offset_ns: that of Velodyne's driver, and whole nanoseconds.
SweepLayout own_sweep_layout();
/// The CustomMsg.
SweepLayout livox_sweep_layout();

/// Names for a reader that takes one IMU and one lidar: the first of each.
struct ReaderNames {
  std::string imu_topic, imu_frame;
  std::string points_topic, lidar_frame;
  std::string body_frame;
  std::string fixed_frame;  ///< on which the body stands still in /tf_static; "": none
};

}  // namespace tumble::scenarios
