// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Limits for the detection of rest at the start. The rate must differ from the gyro bias and its mean by at most
/// kRate_rad_s. The specific force must differ from gravity and its mean by at most kForce_m_s2.
struct StationaryBounds {
  static constexpr double kLevellingMax_s = 0.5;  ///< maximum duration of the initial rest that determines the tilt
  static constexpr double kRate_rad_s = 0.05;
  static constexpr double kForce_m_s2 = 0.5;
};

struct OdometryStart {
  /// standard deviation of the initial tilt as prior of the registration; larger than in WorldCovarianceParams, for
  /// starts in motion
  static constexpr double kLevelSigma_rad = 0.01;
  static constexpr double kBiasRest_s = 0.1;  ///< minimum duration of a rest that determines the gyro bias
};

struct Standstill {
  static constexpr double kSigma_m_s =
      0.05;  ///< standard deviation of the velocity while the IMU measures only gravity
  /// If the IMU measures only gravity and no surface constrains the pose, slower estimated motion than this counts as
  /// rest. The zero velocity prevents slow drift in a world without features.
  static constexpr double kCreepMax_m_s = 0.5;
};

/// Standard deviations of the errors of inertial integration over kSweepInterval_s, in addition to the covariance in
/// AngularRateState. Smaller standard deviations constrain the pose more strongly in a world with few features.
struct InertialNoiseParams {
  static constexpr double kSweepInterval_s = 0.1;  ///< time between two sweeps of most lidars
  double sigma_m = 0.003;
  double sigma_rad = 0.002;
  static constexpr double kSigma_m_s = 0.01;
  /// rotation error relative to the rotation angle
  static constexpr double kRotationNoiseRatio = 0.001;
  /// velocity error relative to the integral of the specific force
  static constexpr double kForceShare = 0.03;
  /// Random walks of velocity and rate during a gap between IMU samples: mapping.md (R43), (R44). Tumbling robots
  /// change by 2.4 to 4.1 m/s and 3 to 11 rad/s per sqrt(s).
  static constexpr double kGapVelocityWalk_m_s_sqrt_s = 3.0;
  static constexpr double kGapRateWalk_rad_s_sqrt_s = 9.0;
  static constexpr double kRateSigmaMax_rad_s =
      5.0;  ///< larger standard deviations in AngularRateState are limited to this value

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m,
          {"prior_sigma_m", "m", 1e-9, 1e3, "standard deviation of the position after 0.1 s of inertial prediction",
           ParameterAudience::common_use});
    visit(p.sigma_rad,
          {"prior_sigma_rad", "rad", 1e-9, 1e3, "standard deviation of the attitude after 0.1 s of inertial prediction",
           ParameterAudience::common_use});
  }
};

/// Parameters for a saturated gyro or accelerometer. Accelerometer readings count as saturated if they are at or above
/// `accel_m_s2`, or have a clip flag.
///
/// If `estimate_deficit` is true, the registration estimates the saturation deficit (true minus estimated rate on
/// clipped gyro axes) at SweepTrajectory::kKnots times per sweep. The prior standard deviation of the saturation
/// deficit is that of the rate in AngularRateState, but at least 1 rad/s, correlated over 0.3 s. The saturation deficit
/// changes only clipped samples, in proportion to the standard deviation of their rate, and is continuous from sweep to
/// sweep.
struct SaturatedImuParams {
  double accel_m_s2 = 1e5;
  static constexpr double kRateSigma_rad_s = 3.0;  ///< standard deviation of a clipped rate that was not recovered
  bool estimate_deficit = false;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.accel_m_s2,
          {"accel_rail_m_s2", "m/s^2", 1e-9, 1e5, "accelerometer readings from this value on count as saturated"});
    visit(p.estimate_deficit,
          boolean_parameter("estimate_saturation_deficit",
                            "1: estimate the saturation deficit of clipped axes in the registration"));
  }
};

struct MatchingParams {
  static constexpr int kNeighbours = 12;
  static constexpr std::size_t kMatchesMin = 100;  ///< sweeps with fewer matched points are rejected
  double distance_m = 1.0;
  std::size_t agreeing_matches_min = 30;  ///< the same limit if the registered pose agrees with the inertial prediction
  double correction_max_m = 15.0;         ///< a larger correction of the prior is rejected
  double correction_max_rad = 1.1;        ///< a larger correction of the prior is rejected
  /// growth rate of a point's standard deviation during the sweep, for errors of the deskewing
  double skew_sigma_m_s = 0.25;
  /// A sweep is `degenerate` if the standard deviation of the pose from the lidar points alone exceeds this value.
  static constexpr double kDegenerateSigma_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.distance_m, {"match_distance_m", "m", 1e-3, 10.0,
                         "maximum distance between a point and its matches in the map", ParameterAudience::common_use});
    visit(p.agreeing_matches_min,
          {"matches_agreeing_min", "1", 1, 1e9,
           "minimum number of matches of an accepted sweep whose registration agrees with the predicted pose; other "
           "sweeps need 100 matches"});
    visit(p.correction_max_m,
          {"correction_max_m", "m", 0.0, 1e6,
           "maximum correction of the predicted pose; a registration with a larger correction is rejected"});
    visit(p.correction_max_rad,
          {"correction_max_rad", "rad", 0.0, 3.15,
           "maximum correction of the predicted pose; a registration with a larger correction is rejected"});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
  }
};

/// Limits for sweeps that could not be registered.
struct TrackingLimits {
  /// A sweep with too few matches is `degenerate` and still extends the map, if the standard deviation of its predicted
  /// position is below this value. Such sweeps occur because the rings of a lidar at rest do not determine planes.
  /// Points that are too uncertain because of their range and the uncertain attitude are not inserted.
  static constexpr double kExtendSigmaMax_m = 0.1;
  /// After this number of consecutive sweeps with points but without registration, LidarInertialOdometry continues by
  /// inertial integration and reports `degenerate`.
  static constexpr int kLostSweepsMax = 30;
};

struct LocalMapParams {
  static constexpr double kPruneRatio =
      0.1;                  ///< points beyond radius_m are deleted after each motion of kPruneRatio * radius_m
  double voxel_m = 0.5;     ///< edge of a cell of the map's hash table
  double spacing_m = 0.1;   ///< edge of the cubes that contain at most one map point
  double radius_m = 100.0;  ///< points within this distance of the sensor are kept

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.voxel_m, {"map_voxel_m", "m", 0.01, 10.0, "edge length of a voxel of the map's hash table",
                      ParameterAudience::common_use});
    visit(
        p.spacing_m,
        {"map_spacing_m", "m", 0.0, 10.0,
         "edge length of the cube that stores at most one map point; a larger value makes the map smaller and coarser",
         ParameterAudience::common_use});
    visit(p.radius_m, {"map_radius_m", "m", 0.0, 1e5,
                       "radius around the sensor within which map points are kept, accurate to 10 %"});
  }
};

/// Errors of the map that the reported covariance includes: docs/maths/mapping.md, heading "Reported covariance".
struct WorldCovarianceParams {
  double tilt_sigma_rad = 0.002;  ///< standard deviation of the tilt at the start: accelerometer bias of 2 mg

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad,
          {"tilt_sigma_rad", "rad", 0.0, 1.0, "reported standard deviation of the map's tilt after initial levelling"});
  }
};

struct OdometryExpertParams {
  double gravity_m_s2 = 9.80665;
  /// prior standard deviation of the horizontal part of gravity; 0: fixed direction of gravity
  double gravity_sigma_m_s2 = 0.0;
  /// number of newest sweeps that the fixed-lag smoother refines together; 1: no smoothing
  int window_sweeps = 2;
  InertialNoiseParams prior = {};
  SaturatedImuParams saturated_imu = {};
  LocalMapParams map = {};
  MatchingParams matching = {};
  WorldCovarianceParams world_covariance = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
    visit(p.gravity_sigma_m_s2,
          {"gravity_sigma_m_s2", "m/s^2", 0.0, 10.0,
           "standard deviation of gravity's horizontal part after initial levelling; 0: fixed direction of gravity",
           ParameterAudience::common_use});
    visit.group("", p.map);
    visit.group("", p.matching);
    visit.group("", p.prior);
    visit.group("", p.saturated_imu);
    visit(p.window_sweeps, {"window_sweeps", "1", 1, 8,
                            "number of newest sweeps that are refined together; each pose is final after this number "
                            "minus one of later sweeps",
                            ParameterAudience::common_use});
    visit.group("world_", p.world_covariance);
  }
};

struct OdometryParams {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  double imu_minus_lidar_clock_s = 0.0;
  /// prior standard deviations of T_IL and of the time offset; 0: exact, not estimated
  double mount_sigma_rad = 0.0;
  double mount_sigma_m = 0.0;
  double time_offset_sigma_s = 0.0;
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d
      own_body_L;               ///< bounding box of the robot in lidar axes; returns inside are dropped; may be empty
  double sweep_voxel_m = 0.25;  ///< the registration uses one point per voxel with this edge
  /// runs the registration on threads of the caller; empty: on the calling thread
  ParallelFor parallel_for;

  using Expert = OdometryExpertParams;
  Expert expert;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.imu_minus_lidar_clock_s,
          {"time_offset_s", "s", -1.0, 1.0, "time of the IMU's clock minus time of the lidar's clock"});
    visit(p.mount_sigma_rad, lidar_calibration_fields::kMountSigmaInfo_rad);
    visit(p.mount_sigma_m, lidar_calibration_fields::kMountSigmaInfo_m);
    visit(p.time_offset_sigma_s, lidar_calibration_fields::kTimeOffsetSigma_s);
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
                            ParameterAudience::common_use});
    visit.group("", p.expert);
  }
};

/// Returns `out_of_range` for the first invalid parameter, including poses.
Status check_odometry_params(const OdometryParams& params);

}  // namespace tumble
