// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Estimates pose and map of a tumbling body from an IMU and a lidar. LidarInertialOdometry integrates the IMU between
/// sweeps, and deskews each point at the time of its firing. Each sweep is registered to a voxel map by point-to-plane
/// distances, and then inserted into the map. The equations are in docs/maths/mapping.md.
///
/// The z axis of the world frame points upwards, along the specific force at rest. The earliest sweep with
/// `matches_min` points starts the map. The pose of the IMU at the first IMU sample defines origin and yaw of the world
/// frame. If the map starts more than half a second after the first IMU sample, or after sweeps with too few points,
/// the pose of the IMU at the start of the map defines origin and yaw.
///
/// Pass IMU samples in time order, and each sweep after the IMU samples that cover the sweep. LidarInertialOdometry
/// starts no threads, uses no files and prints nothing.
///
/// The lidar's mounting, its time offset and gravity are estimated if their standard deviations are not 0. A fixed-lag
/// smoother refines the last `window_sweeps` sweeps. To get a consistent map, process the recording a second time,
/// starting from the result of calibration().
///
/// After a tracking failure (several consecutive sweeps rejected), inertial prediction continues. Until tracking is
/// restored, each sweep is also registered from several starting poses around the predicted pose. LidarInertialOdometry
/// does not model loop closure, moving objects, or IMU biases other than the gyro bias at the start.
class LidarInertialOdometry {
 public:
  using Params = OdometryParams;
  using SweepReport = tumble::SweepReport;

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// A run that continues from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Sets position and heading (not the tilt) of the IMU at the start of the map; the default is the origin. Reported
  /// covariances are relative to the start pose. Call set_start_pose() before the first sweep.
  void set_start_pose(const Eigen::Isometry3d& T_WI);
  const std::optional<Eigen::Isometry3d>& start() const;

  /// attitude correction for a start in motion, where the mean force is not gravity
  struct StartTilt {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< correction of the levelled attitude
    double sigma_rad = 0.0;                                        ///< standard deviation of the corrected tilt
  };
  /// Returns the tilt at the start, computed from the direction of gravity in the map, for a second run over the same
  /// data. start_tilt() is empty after a start at rest, before the map starts, and after localisation in a prior map.
  /// If the standard deviation of the computed tilt is more than half the standard deviation of the initial tilt,
  /// start_tilt() returns the argument of set_start_tilt(), or an empty value if set_start_tilt() was not called.
  std::optional<StartTilt> start_tilt() const;
  /// Call set_start_tilt() before the first sweep.
  void set_start_tilt(const StartTilt& tilt);

  /// Sets the map of an earlier run, in which the robot is then localised. Call use_map() before the first sweep.
  ///
  /// Before localisation, poses are in a local frame, and localised() returns `degenerate`. After localisation, poses
  /// and covariances are in the frame of the prior map, and SweepReport::in_prior_map is true. If `map.T_prior_map_imu`
  /// is set, use_map() also calls set_start_pose(). The whole prior map is kept, also beyond map_radius_m. Returns
  /// `ok`, an error of check_prior_map(), or `time_order` after the first sweep. On error, the state is unchanged.
  Status use_map(PriorMap map);
  /// Copies the prior map, if any, and its parameters from another object, and restarts the localisation. The
  /// localisation searches near the pose of set_start_pose(). If set_start_pose() was not called, the localisation
  /// searches near PriorMap::T_prior_map_imu.
  void use_map_of_pass(const LidarInertialOdometry& other);
  /// Returns `degenerate` if a prior map is set but the robot is not yet localised.
  Status localised() const;
  /// null without a prior map
  const PriorMap* prior_map() const;

  /// `rate` is the estimated angular velocity of the sample. Returns `non_finite` if a number is not finite, or
  /// `time_order` if the sample is not later than the last sample. Returns `out_of_range` if the time stamps of
  /// `sample` and `rate` differ, or exceed kStampMax_ns. On error, the state is unchanged.
  Status add_imu(const ImuSample& sample, const AngularRateState& rate);

  /// Sets the velocity that an odometer measured at the start of the next sweep, in IMU axes, with one standard
  /// deviation for all axes. The odometer's velocity replaces the estimated velocity in the prediction of the next
  /// sweep. Returns `non_finite` if a number is not finite, or `out_of_range` if the standard deviation is not above 0.
  /// On error, the state is unchanged.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
  /// Sets an odometer reading for the prediction of the next sweep. The time stamps of the reading must be between the
  /// end of the last sweep and the end of the next sweep, or at most 20 ms outside; other readings are ignored. The
  /// odometer reading is fused with the inertial prediction, weighted by their covariances. A new odometer reading
  /// replaces an earlier reading and the velocity of add_velocity().
  Status add_reading(const OdometerReading& reading);
  /// Excludes the accelerometer, but not the gyro, from the prediction of the next sweep, and drops earlier odometer
  /// readings for this sweep.
  void exclude_accelerometer();

  /// Registers a sweep of points fired in [start_ns, end_ns]. Consecutive sweeps must not overlap. A point with NaN
  /// coordinates is a laser pulse without a return.
  ///
  /// Returns `time_order` if the sweep ends before its start or overlaps the last sweep. Returns `insufficient_data` if
  /// the IMU samples do not cover the sweep, and `out_of_range` if a point fired outside the sweep. If the points are
  /// unusable, the pose is the inertial prediction and the verdict is `rejected`. The status of unusable points is
  /// `empty` (no points), `non_finite` (no finite point), `insufficient_data` (no point in range) or `degenerate` (one
  /// time stamp). Before the map starts, a sweep with too few usable points has no pose, and `report.trajectory` is
  /// empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Predicts pose and velocity with covariance at the last of `samples`, by inertial integration from the end of the
  /// last sweep. If no sample is later than the last sweep, the result is the pose at the end of the last sweep.
  /// Returns `ok`, an error of add_imu(), or `empty` before the first sweep. `velocity_covariance_I_m2_s2` (optional)
  /// is defined as in SweepReport. Cost: O(samples since the last sweep).
  Status predict(std::span<const ImuSample> samples, std::span<const AngularRateState> rates, PoseState& pose,
                 Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;

  /// Returns the current calibration. Calibration values that are not estimated have covariance 0.
  LidarImuCalibration calibration() const;
  LidarImuCalibration::Covariance calibration_covariance() const;
  /// Returns the covariance with which the next registration weights the current calibration as its prior. A second run
  /// over the recording that starts from calibration() should start with this covariance.
  LidarImuCalibration::Covariance calibration_prior_covariance() const;

  /// Returns `out_of_range` while the standard deviation of gravity's direction exceeds 0.02 rad, for example after a
  /// start in motion.
  Status check_vertical() const;

  /// Estimates the pose at a time within the last `window_sweeps` sweeps. Returns `out_of_range` outside these sweeps.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Returns the current poses of the last `window_sweeps` sweeps, oldest first, which later sweeps still refine. The
  /// whole trajectory consists of all SweepReport::smoothed, followed by window_trajectories().
  std::vector<std::vector<PoseState>> window_trajectories() const;

  std::size_t map_bytes() const;

  /// Returns the map points within `map_radius_m` of the robot. The normals are fitted to nearest neighbours, and point
  /// towards the sensor position at the observation. Points that two later sweeps saw through, for example points on
  /// people who have walked away, are omitted. Cost: O(number of points).
  std::vector<MapPoint> map() const;

  struct Impl;  ///< private implementation

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
