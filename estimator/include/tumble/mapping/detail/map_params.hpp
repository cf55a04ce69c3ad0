// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

struct LocalMapParams {
  static constexpr double kPruneRatio = 0.1;  ///< distant points are deleted after a motion of kPruneRatio * radius_m
  double voxel_m = 0.5;                       ///< edge of a cell of the map's hash table
  double spacing_m = 0.1;                     ///< edge of the cubes that contain at most one map point
  double radius_m = 100.0;                    ///< points within this distance of the sensor are kept

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.voxel_m, {"map_voxel_m", "m", 0.01, 10.0, "edge length of a voxel of the map's hash table",
                      ParameterRank::common_use});
    visit(
        p.spacing_m,
        {"map_spacing_m", "m", 0.0, 10.0,
         "edge length of the cube that stores at most one map point; a larger value makes the map smaller and coarser",
         ParameterRank::common_use});
    visit(p.radius_m, {"map_radius_m", "m", 0.0, 1e5,
                       "radius around the sensor within which map points are kept, accurate to 10 %"});
  }
};

/// See docs/maths/mapping.md, heading "Reported covariance".
struct WorldCovarianceParams {
  double tilt_sigma_rad = 0.002;  ///< standard deviation of the tilt at the start: accelerometer bias of 2 mg

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad,
          {"tilt_sigma_rad", "rad", 0.0, 1.0, "reported standard deviation of the map's tilt after initial levelling"});
  }
};

}  // namespace tumble
