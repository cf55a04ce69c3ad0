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

std::span<const std::pair<const char*, LidarSheet (*)()>> lidars() {
  static constexpr std::pair<const char*, LidarSheet (*)()> kAll[] = {
      {"rs16", rs16}, {"mid40", mid40}, {"mid100", mid100}};
  return kAll;
}

}  // namespace tumble::sheets
