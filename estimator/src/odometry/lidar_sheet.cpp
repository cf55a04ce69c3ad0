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

LidarSheet vlp16() {
  return {.range_min_m = 0.4, .range_max_m = 100.0};
}

LidarSheet xt16() {
  return {.range_min_m = 0.05, .range_max_m = 120.0};
}

LidarSheet xt32() {
  return {.range_min_m = 0.05, .range_max_m = 120.0};
}

LidarSheet helios32() {
  return {.range_min_m = 0.2, .range_max_m = 150.0};
}

LidarSheet os0_64() {
  return {.range_min_m = 0.3, .range_max_m = 50.0};
}

LidarSheet os0_128() {
  return {.range_min_m = 0.3, .range_max_m = 50.0};
}

LidarSheet os1_64() {
  return {.range_min_m = 0.3, .range_max_m = 120.0};
}

LidarSheet os1_128() {
  return {.range_min_m = 0.3, .range_max_m = 120.0};
}

LidarSheet mid360() {
  return {.range_min_m = 0.1, .range_max_m = 70.0};
}

std::span<const std::pair<const char*, LidarSheet (*)()>> lidars() {
  static constexpr std::pair<const char*, LidarSheet (*)()> kAll[] = {
      {"rs16", rs16},       {"mid40", mid40},   {"mid100", mid100},     {"vlp16", vlp16},
      {"xt16", xt16},       {"xt32", xt32},     {"helios32", helios32}, {"os0_64", os0_64},
      {"os0_128", os0_128}, {"os1_64", os1_64}, {"os1_128", os1_128},   {"mid360", mid360}};
  return kAll;
}

}  // namespace tumble::sheets
