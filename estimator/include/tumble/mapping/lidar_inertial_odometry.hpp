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
/// sweeps, and deskews each lidar point with the pose at which the point was measured. LidarInertialOdometry registers
/// each sweep to a voxel map by minimising point-to-plane distances, and then inserts the sweep into the map. The
/// equations are in docs/maths/mapping.md.
///
/// The z axis of the world frame points upwards, along the specific force at rest. The first sweep with at least
/// `matches_min` usable points starts the map. The pose of the IMU at the first IMU sample defines origin and yaw of
/// the world frame. In two cases, the IMU pose at the start of the map defines origin and yaw instead: the map starts
/// more than 0.5 s after the first IMU sample, or earlier sweeps had too few points.
///
/// Pass IMU samples in time order. Before each sweep, pass the IMU samples up to the end of the sweep.
/// LidarInertialOdometry starts no threads, uses no files and prints nothing.
///
/// Lidar pose in IMU axes, time offset between IMU and lidar, and gravity are estimated if their prior standard
/// deviations are not 0. A fixed-lag smoother refines the poses of the last `window_sweeps` sweeps. To get a consistent
/// map, process the recording twice, and start the second run with the result of lidar_calibration() after the first
/// run.
///
/// After a tracking failure (a rejected sweep), inertial integration continues the pose. Until tracking is restored,
/// the registration of each sweep also tries several starting poses around the predicted pose. LidarInertialOdometry
/// does not model loop closure, moving objects, or IMU biases other than the gyro bias at the start.
class LidarInertialOdometry {
 public:
  using Params = OdometryParams;
  using SweepResult = tumble::SweepResult;

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// A copy and its original give bit-identical results for the same further data.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Sets position and heading of the IMU at the start; the tilt follows from the accelerometer. Without
  /// set_start_pose(), the IMU starts at the origin. Reported covariances describe errors relative to the start pose.
  /// Call set_start_pose() before the first sweep.
  void set_start_pose(const Eigen::Isometry3d& T_WI);
  const std::optional<Eigen::Isometry3d>& start_pose() const;

  /// Correction of the initial tilt. After a start in motion, the initial tilt is wrong, because the mean specific
  /// force does not have the direction of gravity.
  struct StartTiltCorrection {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< corrected attitude = rotation * initial attitude
    double sigma_rad = 0.0;                                        ///< standard deviation of the corrected tilt
  };
  /// Returns a correction of the initial tilt for a second run over the same data, computed from the estimated
  /// direction of gravity in the map. The result is empty after a start at rest, before the map starts, and after
  /// localisation in a prior map. A new correction must at least halve the standard deviation of the initial tilt.
  /// Otherwise, start_tilt_correction() returns the last argument of set_start_tilt_correction(), or an empty value
  /// without such a call.
  std::optional<StartTiltCorrection> start_tilt_correction() const;
  /// Call set_start_tilt_correction() before the first sweep.
  void set_start_tilt_correction(const StartTiltCorrection& tilt);

  /// Sets the map of an earlier run as prior map, and starts the localisation of the robot in the prior map. Call
  /// set_prior_map() before the first sweep.
  ///
  /// Before localisation, poses are not in the frame of the prior map, and check_localised() returns `degenerate`.
  /// After localisation, poses and covariances are in the frame of the prior map, and SweepResult::in_prior_map is
  /// true. If `map.start_T_MI` is set, set_prior_map() passes this pose to set_start_pose(). All points of the prior
  /// map are kept, also beyond `map_radius_m` from the robot. Returns `ok`, an error of check_prior_map(), or
  /// `time_order` if the mapping has already started. If set_prior_map() returns an error, the state is unchanged.
  Status set_prior_map(PriorMap map);
  /// Copies the prior map, if any, from `other`, and restarts the localisation. The localisation searches near the pose
  /// of set_start_pose(), or without a start pose near PriorMap::start_T_MI.
  void copy_prior_map(const LidarInertialOdometry& other);
  /// Returns `degenerate` if a prior map is set but the robot is not yet localised.
  Status check_localised() const;
  /// Transforms poses that were reported before the localisation to the frame of the prior map. The covariances then
  /// include the uncertainty of the localisation. Returns `degenerate` before the localisation.
  Status convert_to_prior_map_frame(std::span<PoseState> poses) const;
  /// Returns the prior map, or null without a prior map.
  const PriorMap* prior_map() const;

  /// Adds an IMU sample. `rate` is the estimated angular velocity at the time of the sample. Returns `non_finite` if a
  /// number is not finite, or `time_order` if the sample is not later than the last sample. Returns `out_of_range` if
  /// the time stamps of `sample` and `rate` differ, or exceed kStampMax_ns. If add_imu() returns an error, the state is
  /// unchanged.
  Status add_imu(const ImuSample& sample, const AngularRateState& rate);

  /// Sets an odometer reading for the prediction of the next sweep's pose. An odometer reading that extends beyond the
  /// next sweep by more than 20 ms is ignored. The odometer reading is fused with the inertial prediction, weighted by
  /// their covariances. Each sweep uses only the odometer reading of the last call of set_odometer_reading().
  Status set_odometer_reading(const OdometerReading& reading);

  /// Registers a sweep of points fired in [start_ns, end_ns]. Consecutive sweeps must not overlap. A point with NaN
  /// coordinates is a laser pulse without a return.
  ///
  /// Returns `time_order` if the sweep ends before its start or overlaps the last sweep. Returns `insufficient_data` if
  /// the IMU samples do not cover the sweep, and `out_of_range` if a point was fired outside [start_ns, end_ns]. If the
  /// points are unusable, the pose is the inertial prediction and the verdict is `rejected`. For unusable points,
  /// add_sweep() returns `empty` (no points), `non_finite` (no finite point), `insufficient_data` (no point in range)
  /// or `degenerate` (all points have one time stamp). Before the map starts, a sweep with too few usable points has no
  /// pose, and `result.trajectory` is empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepResult& result);

  /// Predicts pose, velocity and covariance of the IMU at the time of the last sample in `samples`, by inertial
  /// integration from the end of the last sweep. If no sample is later than the last sweep, the result is the pose at
  /// the end of the last sweep. Returns `ok`, an error of add_imu(), or `empty` before the map has started.
  /// `velocity_covariance_I_m2_s2` (optional) is defined as in SweepResult. Cost: O(samples since the last sweep).
  Status predict(std::span<const ImuSample> samples, std::span<const AngularRateState> rates, PoseState& pose,
                 Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;

  /// Returns the estimated pose of the lidar in IMU axes, time offset and gravity. A value that is not estimated has
  /// covariance 0 in lidar_calibration_covariance().
  LidarImuCalibration lidar_calibration() const;
  LidarImuCalibration::Covariance lidar_calibration_covariance() const;
  /// Returns the covariance that the next registration uses as prior of the calibration. A second run over the same
  /// recording should start with the results of lidar_calibration() and next_lidar_calibration_prior_covariance().
  LidarImuCalibration::Covariance next_lidar_calibration_prior_covariance() const;

  /// Returns `out_of_range` while the standard deviation of gravity's direction exceeds 0.02 rad, for example after a
  /// start in motion.
  Status check_gravity_direction() const;

  /// Estimates the pose of the IMU at a time within the last `window_sweeps` sweeps; for other times, pose_at() returns
  /// `out_of_range`.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Returns the current IMU poses of the sweeps that later sweeps still refine (at most `window_sweeps` - 1 sweeps),
  /// oldest first. To get the whole trajectory at the end of a run, append these poses to the poses of all
  /// SweepResult::final_poses_of_earlier_sweep.
  std::vector<std::vector<PoseState>> window_trajectories() const;

  std::size_t map_memory_bytes() const;

  /// Returns the map points within about `map_radius_m` of the robot, and the points of a prior map. Each normal is
  /// fitted to the nearest neighbours of its point, and points towards the sensor that observed the point. The returned
  /// map omits points through which beams of two sweeps passed, for example points on people who have walked away.
  /// Cost: O(number of points).
  std::vector<MapPoint> map() const;

  struct Impl;  ///< private implementation

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
