// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tumble/common/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// lidar return in lidar axes L at the time when the laser fired, not deskewed
struct LidarPoint {
  Eigen::Vector3f position_L_m = Eigen::Vector3f::Zero();
  float intensity = 0.0f;       ///< 0 to 1
  std::uint32_t offset_ns = 0;  ///< firing time after the start of the sweep
  std::uint16_t ring = 0;       ///< number of the laser, from bottom to top, or of the scan line
};

/// point of the map, in world axes
struct MapPoint {
  Eigen::Vector3f position_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit normal; zero if no plane could be fitted
  float sigma_m = 0.0f;                                ///< standard deviation of the position
};

}  // namespace tumble
