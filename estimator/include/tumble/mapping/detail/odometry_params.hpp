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

/// OdometryExpertParams contains the rarely changed parameters of LidarInertialOdometry, grouped by topic.
struct OdometryExpertParams {
  double gravity_m_s2 = 9.80665;
  /// Standard deviation of gravity's horizontal part. If gravity_sigma_m_s2 is 0, the direction of gravity is fixed.
  double gravity_sigma_m_s2 = 0.0;
  /// Number of newest sweeps that the fixed-lag smoother refines together (see SweepReport::smoothed). If window_sweeps
  /// is 1, smoothing is disabled.
  int window_sweeps = 2;
  RestBoundsParams rest = {};
  OdometryStartParams start = {};
  StandstillParams standstill = {};
  InertialNoiseParams prior = {};
  SaturatedImuParams rails = {};
  FlightParams flight = {};
  LocalMapParams map = {};
  MatchingParams matching = {};
  TrackingParams tracking = {};
  RelocalisationParams search = {};
  WorldCovarianceParams world = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
    visit(p.gravity_sigma_m_s2, {"gravity_sigma_m_s2", "m/s^2", 0.0, 10.0,
                                 "standard deviation of gravity after initial levelling; 0: exact", FieldRank::basic});
    visit.group("", p.rest);
    visit.group("", p.map);
    visit.group("", p.matching);
    visit.group("", p.prior);
    visit.group("", p.rails);
    visit(p.window_sweeps, {"window_sweeps", "1", 1, 8,
                            "number of sweeps that are refined together; the estimate of a sweep uses this number "
                            "minus one of later sweeps",
                            FieldRank::basic});
    visit.group("", p.flight);
    visit.group("", p.tracking);
    visit.group("start_", p.start);
    visit.group("standstill_", p.standstill);
    visit.group("search_", p.search);
    visit.group("world_", p.world);
  }
};

/// OdometryParams contains the parameters of LidarInertialOdometry.
struct OdometryParams {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  double time_offset_s = 0.0;                              ///< IMU clock minus lidar clock
  /// Standard deviations of T_IL and of the time offset. A standard deviation of 0 marks an exact quantity, which is
  /// not estimated.
  double mount_sigma_rad = 0.0;
  double mount_sigma_m = 0.0;
  double time_offset_sigma_s = 0.0;
  double range_min_m = 0.3;        ///< minimum range of a usable return
  double range_max_m = 100.0;      ///< maximum range of a usable return
  Eigen::AlignedBox3d own_body_L;  ///< returns inside this box hit the robot and are removed; empty: none
  double sweep_voxel_m = 0.25;     ///< edge of the voxels; the registration uses one point per voxel
  /// Runs the loops of the registration on the caller's threads. The results do not depend on the number of threads.
  ParallelFor parallel_for;

  using Expert = OdometryExpertParams;
  Expert expert;  ///< rarely changed parameters

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
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
           "minimum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
    visit(p.own_body_L.max(),
          {"own_body_max_m", "m", -kUnbounded, kUnbounded,
           "maximum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
    visit(p.sweep_voxel_m, {"sweep_voxel_m", "m", 0.01, 10.0,
                            "edge length of the voxels; one point per voxel and sweep is registered, so a larger value "
                            "is faster and coarser",
                            FieldRank::basic});
    visit.group("", p.expert);
  }
};

/// Checks all parameters of LidarInertialOdometry, including poses. Returns `out_of_range` for the first invalid
/// parameter.
Status check_odometry_params(const OdometryParams& params);

}  // namespace tumble
