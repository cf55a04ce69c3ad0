// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// Groups of LidarInertialOdometry::Params::Expert: what is kept of the map, and how sure it is.
namespace tumble {

/// What is kept of the world.
struct LocalMapParams {
  static constexpr double kPruneShare = 0.1;  ///< of radius_m: moved so far, the sensor drops what is out of reach
  double voxel_m = 0.5;                       ///< cell of the map's hash
  double spacing_m = 0.1;                     ///< at most one map point per cube of this edge
  double radius_m = 100.0;                    ///< it is kept within this of the sensor, to a tenth of it
  double sigma_max_m = 0.25;                  ///< points that the trajectory places less surely than this are kept out

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.voxel_m, {"map_voxel_m", "m", 0.01, 10.0, "edge of a voxel of the map's hash table", Rank::first});
    visit(p.spacing_m,
          {"map_spacing_m", "m", 0.0, 10.0, "edge of the cube that stores at most one map point", Rank::first});
    visit(p.radius_m,
          {"map_radius_m", "m", 0.0, 1e5, "radius around the sensor within which the map is kept, to 10 %"});
    visit(p.sigma_max_m, {"map_sigma_max_m", "m", 1e-6, 1e3,
                          "largest standard deviation of a point's position for insertion into the map"});
  }
};

/// What parts the map from the world: docs/maths/mapping.md, section 8.
struct WorldCovarianceParams {
  double tilt_sigma_rad = 0.002;  ///< of a levelled start: an accelerometer's turn-on bias of 2 mg
  /// Of the weakest direction's standard deviation, per sweep, where the surfaces do not hold it: measured.
  double drift_share = 0.1;
  double drift_sigma_max_m = 3.0;  ///< a direction held less surely counts as this

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad,
          {"tilt_sigma_rad", "rad", 0.0, 1.0, "reported standard deviation of the tilt after initial levelling"});
    visit(p.drift_share, {"drift_share", "1", 0.0, 1.0,
                          "map drift per sweep, as a share of the standard deviation of the weakest direction"});
    visit(p.drift_sigma_max_m,
          {"drift_sigma_max_m", "m", 0.0, 1e3, "upper limit of the standard deviation that enters the map drift"});
  }
};

}  // namespace tumble
