// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/lidar_sheet.hpp"

namespace tumble::sheets {

LidarSheet rs16() {
  return {.range_min_m = 0.2, .range_max_m = 150.0};
}

LidarSheet mid40() {
  return {.range_min_m = 1.0, .range_max_m = 260.0};
}

LidarSheet mid100() {
  return {.range_min_m = 1.0, .range_max_m = 260.0};
}

}  // namespace tumble::sheets
