// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// PriorMap is the map of an earlier run, in which a new run localises the robot. M is the frame of the prior map. The
/// z axis of M is vertical, as in every map of this library.
struct PriorMap {
  std::vector<MapPoint> points = {};  ///< points with normals, in M; to_map_points() computes normals
  /// Pose of the IMU in M where the new run starts, if known. Only position and heading are used. If empty, the run may
  /// start anywhere in the map, and the search covers the whole map.
  std::optional<Eigen::Isometry3d> T_MI = std::nullopt;
  double sigma_m = 0.0;    ///< standard deviation of the position of T_MI per axis; 0: exact
  double sigma_rad = 0.0;  ///< standard deviation of the heading of T_MI; 0: exact
  bool extend =
      true;  ///< true: sweeps extend the map and remove points that they see through; false: the map is constant
};

/// Checks map points. Returns `non_finite`, or `out_of_range` for a negative standard deviation, an invalid normal, or
/// a position beyond 50 km. A valid normal is zero or has unit length.
Status check_map_points(std::span<const MapPoint> points);
/// Checks the points and the pose of a prior map. Returns `ok`, an error of check_map_points(), or `too_few` if fewer
/// than 100 points have a normal.
Status check_prior_map(const PriorMap& map);

/// Returns map points with normals for positions, for example of a PCD or PLY file. The function fits planes like
/// LidarInertialOdometry::map(). The function keeps at most one point per cube of 0.1 m. The sign of a normal is
/// arbitrary, and `sigma_m` is the standard deviation of each position. The function drops positions that are not
/// finite. Cost: O(points).
std::vector<MapPoint> to_map_points(std::span<const Eigen::Vector3f> positions_M_m, float sigma_m = 0.02f);

}  // namespace tumble
