// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/executor.hpp"
#include "tumble/mapping/detail/inertial_params.hpp"
#include "tumble/mapping/detail/map_params.hpp"
#include "tumble/mapping/detail/placing_params.hpp"
#include "tumble/mapping/detail/rest_params.hpp"

namespace tumble {

struct OdometryExpertParams {
  double gravity_m_s2 = 9.80665;
  /// standard deviation of the horizontal part of gravity; 0: fixed direction of gravity
  double gravity_sigma_m_s2 = 0.0;
  /// number of newest sweeps that the fixed-lag smoother refines together; 1: no smoothing
  int window_sweeps = 2;
  StationaryBoundsParams stationary_bounds = {};
  OdometryStartParams start = {};
  InertialNoiseParams prior = {};
  SaturatedImuParams saturated_imu = {};
  LocalMapParams map = {};
  MatchingParams matching = {};
  TrackingParams tracking = {};
  WorldCovarianceParams world_covariance = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
    visit(p.gravity_sigma_m_s2,
          {"gravity_sigma_m_s2", "m/s^2", 0.0, 10.0,
           "standard deviation of gravity's horizontal part after initial levelling; 0: fixed direction of gravity",
           ParameterRank::common_use});
    visit.group("", p.stationary_bounds);
    visit.group("", p.map);
    visit.group("", p.matching);
    visit.group("", p.prior);
    visit.group("", p.saturated_imu);
    visit(p.window_sweeps, {"window_sweeps", "1", 1, 8,
                            "number of newest sweeps that are refined together; each pose is final after this number "
                            "minus one of later sweeps",
                            ParameterRank::common_use});
    visit.group("", p.tracking);
    visit.group("start_", p.start);
    visit.group("world_", p.world_covariance);
  }
};

struct OdometryParams {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  double time_offset_s = 0.0;                              ///< IMU clock minus lidar clock
  /// standard deviations of T_IL and of the time offset; 0: exact, not estimated
  double mount_sigma_rad = 0.0;
  double mount_sigma_m = 0.0;
  double time_offset_sigma_s = 0.0;
  double range_min_m = 0.3;        ///< minimum range of a usable return
  double range_max_m = 100.0;      ///< maximum range of a usable return
  Eigen::AlignedBox3d own_body_L;  ///< bounding box of the robot's own body, whose returns are dropped; may be empty
  double sweep_voxel_m = 0.25;     ///< edge of the voxels; the registration uses one point per voxel
  /// threads of the caller for the registration; empty: the calling thread
  ParallelFor parallel_for;

  using Expert = OdometryExpertParams;
  Expert expert;  ///< rarely changed parameters

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.time_offset_s,
          {"time_offset_s", "s", -1.0, 1.0, "time of the IMU's clock minus time of the lidar's clock"});
    visit(p.mount_sigma_rad, calibration_fields::kMountSigma_rad);
    visit(p.mount_sigma_m, calibration_fields::kMountSigma_m);
    visit(p.time_offset_sigma_s, calibration_fields::kTimeOffsetSigma_s);
    visit(p.range_min_m, {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped"});
    visit(p.range_max_m, {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped"});
    visit(p.own_body_L.min(),
          {"own_body_min_m", "m", -kUnbounded, kUnbounded,
           "minimum corner of the bounding box of the robot's own body, lidar axes; returns inside are dropped"});
    visit(p.own_body_L.max(),
          {"own_body_max_m", "m", -kUnbounded, kUnbounded,
           "maximum corner of the bounding box of the robot's own body, lidar axes; returns inside are dropped"});
    visit(p.sweep_voxel_m, {"sweep_voxel_m", "m", 0.01, 10.0,
                            "edge length of the voxels; one point per voxel is registered, so a larger value is "
                            "faster and coarser",
                            ParameterRank::common_use});
    visit.group("", p.expert);
  }
};

/// Returns `out_of_range` for the first invalid parameter, including poses.
Status check_odometry_params(const OdometryParams& params);

}  // namespace tumble
