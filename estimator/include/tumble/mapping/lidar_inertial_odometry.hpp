// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "tumble/mapping/further_readings.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/prior_map.hpp"
#include "tumble/mapping/sweep_report.hpp"

namespace tumble {

/// Estimates pose and map of a tumbling body from an IMU and a lidar. LidarInertialOdometry integrates the IMU between
/// sweeps, and deskews each point at the time of its firing. LidarInertialOdometry registers each sweep to a voxel map
/// by k-nearest-neighbour point-to-plane distances, and then inserts the sweep into the map. The registration refines
/// position, attitude and velocity at the start of a sweep together. The refined velocity also improves the deskewing.
///
/// The z axis of the world frame points upwards, along the specific force at rest. The earliest sweep with
/// `matches_min` points starts the map. If the map starts within half a second after the first IMU sample, that sample
/// defines origin and yaw of the world. If the map starts later, its first sweep defines origin and yaw, and dead
/// reckoning gives velocity and tilt. Pass IMU samples in time order. Pass each sweep after the IMU samples that cover
/// the sweep. LidarInertialOdometry starts no threads, uses no files and prints nothing.
///
/// LidarInertialOdometry estimates the lidar's mounting, its time offset and gravity if their standard deviations are
/// not 0. All unknowns form one state with one covariance. LidarInertialOdometry is an iterated error-state filter over
/// sweeps. A fixed-lag smoother refines the last `window_sweeps` sweeps with the data of later sweeps, and moves the
/// map points of the refined sweeps. Map points of older sweeps keep their positions. To get a consistent map, process
/// the recording a second time, starting from the calibration that calibration() returns.
///
/// LidarInertialOdometry computes the reported covariances by propagating the errors through the gains of the filter.
/// The residuals of the registration determine the covariance of the registered pose
/// (Registration::Result::score_covariance).
///
/// Tracking has failed if the registration rejects several consecutive sweeps. After a tracking failure,
/// LidarInertialOdometry continues with inertial prediction, and with zero velocity while the IMU is at rest. Until
/// tracking is restored, each sweep is also registered from several starting poses around the prediction, coarse to
/// fine. LidarInertialOdometry does not model loop closure, moving objects, or IMU biases other than the gyro bias at
/// the start.
class LidarInertialOdometry {
 public:
  using Params = OdometryParams;
  using SweepReport = tumble::SweepReport;

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// Copies the complete state. A run that continues from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Sets position and heading of the IMU at the start of the map. The tilt comes from the specific force at rest.
  /// Covariances are relative to the start pose. Call set_start_pose() before the first sweep. Without a call of
  /// set_start_pose(), the map starts at the origin.
  void set_start_pose(const Eigen::Isometry3d& T_WI);
  /// Returns the pose that was passed to set_start_pose(), if any.
  const std::optional<Eigen::Isometry3d>& start() const;

  /// Correction of the attitude at a start in motion, where the mean force is not gravity.
  struct StartTilt {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< correction of the levelled attitude
    double sigma_rad = 0.0;                                        ///< standard deviation of the corrected tilt
  };
  /// Returns the tilt at the start, computed from the direction of gravity in the map. A second run over the same data
  /// can use it. The result is empty after a start at rest, or if the motion does not determine gravity more accurately
  /// than the start.
  std::optional<StartTilt> start_tilt() const;
  /// Sets the tilt of a start in motion. Call set_start_tilt() before the first sweep.
  void set_start_tilt(const StartTilt& tilt);

  /// Sets the map of an earlier run, in which LidarInertialOdometry then localises the robot. Call use_map() before the
  /// first sweep.
  ///
  /// Until the robot is localised, poses are in a local frame, and localised() returns `degenerate`.
  /// LidarInertialOdometry compares the local map with the prior map after each registered sweep. After localisation,
  /// poses and covariances are in the frame of the prior map, and SweepReport::in_prior_map is true. If `map.T_MI` is
  /// set, use_map() also calls set_start_pose(). LidarInertialOdometry keeps the whole prior map, also beyond
  /// map_radius_m. Returns `ok`, an error of check_prior_map(), or `time_order` after the first sweep. On error, the
  /// state is unchanged.
  Status use_map(PriorMap map);
  /// Copies the prior map, if any, and the parameters of the prior map from another object. The localisation restarts
  /// from the pose of set_start_pose(), or else from the pose in the prior map.
  void use_map_of(const LidarInertialOdometry& other);
  /// Returns `degenerate` if a prior map is set but the robot is not yet localised, and otherwise `ok`.
  Status localised() const;
  /// Returns the map of use_map(), or null.
  const PriorMap* prior_map() const;

  /// Processes an IMU sample and its estimated angular velocity `rate`. Returns `non_finite`, `time_order`, or
  /// `out_of_range` if `rate` has another time stamp. On error, the state is unchanged. The first sample after a gap
  /// bridges the gap and increases the uncertainty of the predicted motion.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// Sets an odometer's velocity at the start of the next sweep, which is the end of the last sweep. The odometer's
  /// velocity is in IMU axes, with one standard deviation for all axes. The odometer's velocity replaces the estimated
  /// velocity only in the prediction of the next sweep. Returns `non_finite` if a number is not finite, or
  /// `out_of_range` if the standard deviation is not above 0. On error, the state is unchanged.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
  /// Sets an odometer's reading for the next sweep. The reading must be between the end of the last sweep and the end
  /// of the next sweep, with a margin of 20 ms. LidarInertialOdometry fuses the reading with the inertial prediction,
  /// weighted by their covariances. A new odometer reading replaces an earlier reading and the velocity of
  /// add_velocity(). An odometer reading outside the time of the next sweep has no effect.
  Status add_reading(const OdometerReading& reading);
  /// Excludes the accelerometer from the prediction of the next sweep. Without the accelerometer, LidarInertialOdometry
  /// predicts the velocity as in a gap, but still uses the gyro. A call of exclude_accelerometer() replaces earlier
  /// odometer readings for the next sweep.
  void exclude_accelerometer();

  /// Registers a sweep of points fired in [start_ns, end_ns]. Consecutive sweeps must not overlap. A point with NaN
  /// coordinates is a laser pulse without a return.
  ///
  /// Three errors of add_sweep() leave the state unchanged. `time_order` means that the end is before the start, or
  /// that the start is before the end of the last sweep. `too_few` means that the IMU samples do not cover the sweep.
  /// `out_of_range` means that the firing time of a point is outside the sweep. If the points are unusable, the pose is
  /// the inertial prediction and the verdict is `rejected`. For unusable points, the status is `empty` (no points),
  /// `non_finite` (no finite point), `too_few` (no point in range) or `degenerate` (one time stamp). Before the map
  /// starts, a sweep with too few usable points has no pose, and `report.trajectory` is empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Predicts pose and velocity with covariance at the last of `samples`, by inertial integration from the end of the
  /// last sweep. The state of the odometry is unchanged. If no sample is later than the last sweep, predict() returns
  /// the pose at the end of the last sweep. Call predict() to get a pose before the next sweep is complete. Returns
  /// `ok`, an error of add_imu(), or `empty` before the first sweep. Cost: O(samples since the last sweep). The
  /// optional output `velocity_covariance_I_m2_s2` is defined as in SweepReport.
  Status predict(std::span<const ImuSample> samples, std::span<const RateState> rates, PoseState& pose,
                 Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;

  /// Returns the current calibration and the covariance of its errors. Calibration values that are not estimated have
  /// covariance 0.
  SweepCalibration calibration() const;
  SweepCalibration::Covariance calibration_covariance() const;
  /// Returns the prior covariance of the calibration for the registration of the next sweep. The prior covariance is
  /// larger than the covariance of the errors, because correlated points have reduced weights. A second run over the
  /// recording starts with the prior covariance.
  SweepCalibration::Covariance calibration_weighting_covariance() const;

  /// Returns `out_of_range` while the standard deviation of gravity's direction exceeds 0.02 rad, and otherwise `ok`. A
  /// run that starts in motion has an uncertain vertical until the motion determines gravity.
  Status check_vertical() const;

  /// Estimates the pose at any time within the window of sweeps, from all data so far. Returns `out_of_range` for a
  /// time outside the window.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Returns the current poses of the sweeps in the window, oldest first. The poses in the window are not final,
  /// because later sweeps still refine them. The whole trajectory consists of all SweepReport::smoothed, followed by
  /// window_trajectories().
  std::vector<std::vector<PoseState>> window_trajectories() const;

  /// Returns the size of the map in memory [bytes].
  std::size_t map_bytes() const;

  /// Returns the map points within `map_radius_m` of the robot. Cost: O(number of points). The normals are fitted to
  /// nearest neighbours, and point towards the sensor position at the observation. The result omits points that two
  /// later sweeps saw through, for example points on people who have walked away.
  std::vector<MapPoint> map() const;

  struct Impl;  ///< private implementation

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
