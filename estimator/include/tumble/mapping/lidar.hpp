// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tumble/common/detail/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// LidarPoint is one lidar return in the lidar's axes L at the time of its firing, not deskewed.
struct LidarPoint {
  Eigen::Vector3f position_L_m = Eigen::Vector3f::Zero();
  float intensity = 0.0f;       ///< 0..1
  std::uint32_t offset_ns = 0;  ///< time of firing after the start of the sweep
  std::uint16_t ring = 0;       ///< channel, counted from bottom to top, or scan line
};

/// MapPoint is a point of the map, in the world.
struct MapPoint {
  Eigen::Vector3f position_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit length; zero if no plane could be fitted
  float sigma_m = 0.0f;                                ///< standard deviation of the position
};

}  // namespace tumble
