// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// Map of an earlier run, in which a new run localises the robot. The map frame M has the axis z up.
struct PriorMap {
  std::vector<MapPoint> points = {};  ///< points with normals, in the map frame M; to_map_points() computes normals
  /// Start pose of the IMU in the map frame M, if known; only position and heading are used. If the start pose is
  /// unknown, the run may start anywhere in the map.
  std::optional<Eigen::Isometry3d> T_prior_map_imu = std::nullopt;
  double sigma_m = 0.0;    ///< standard deviation of the position of T_prior_map_imu per axis; 0: exact
  double sigma_rad = 0.0;  ///< standard deviation of the heading of T_prior_map_imu; 0: exact
  bool extend =
      true;  ///< true: sweeps extend the map and remove points that they see through; false: the map is constant
};

/// Returns `non_finite`, or `out_of_range` for a negative standard deviation, a normal that is neither zero nor a unit
/// vector, or a position beyond 50 km.
Status check_map_points(std::span<const MapPoint> points);
/// Returns `ok`, an error of check_map_points(), or `insufficient_data` if fewer than 100 points have a normal.
Status check_prior_map(const PriorMap& map);

/// Converts positions, for example of a PCD or PLY file, to map points with normals. At most one point per cube of 0.1
/// m remains, and positions that are not finite are dropped. The sign of a normal is arbitrary, and `sigma_m` is the
/// standard deviation of each position. Cost: O(points).
std::vector<MapPoint> to_map_points(std::span<const Eigen::Vector3f> positions_M_m, float sigma_m = 0.02f);

}  // namespace tumble
