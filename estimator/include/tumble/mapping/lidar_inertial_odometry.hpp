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
#include "tumble/mapping/detail/odometer_reading.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/odometry_params.hpp"
#include "tumble/mapping/sweep_report.hpp"

namespace tumble {

class StateWriter;
class StateReader;
class StateLayout;

/// Estimates pose and map of a tumbling body from an IMU and a lidar. The mapper integrates the IMU between sweeps and
/// deskews each point at the time of its firing. The mapper registers the sweep to a voxel map by k-nearest-neighbour
/// point-to-plane distances, and then extends the map. The registration refines position, attitude and velocity at the
/// start of a sweep together, which also refines the deskewing.
///
/// World: z up, levelled by the specific force at rest. The earliest sweep with `matches_min` points starts the map. If
/// the sweep that starts the map begins within half a second of the IMU's first sample, origin and yaw are those of the
/// IMU at that sample. If the sweep begins later, origin and yaw are those of the IMU at the start of the sweep.
/// Velocity and tilt of the later sweep come from dead reckoning. Pass IMU samples in time order, then pass each sweep
/// when IMU samples reach the sweep's end. The class starts no threads, uses no files and prints nothing.
///
/// The lidar's mounting, its time offset and gravity are estimated if their standard deviations are not 0. All unknowns
/// form one state with one covariance. The estimator is an iterated error-state filter over sweeps. A fixed-lag
/// smoother refines the last window_sweeps with later sweeps, including the points of these sweeps in the map. Map
/// points of older sweeps are not moved. A caller that stores its recording can process the recording a second time,
/// starting from calibration(), to get a consistent map.
///
/// Reported covariances follow the errors through the filter's weights. The contribution of the registration is
/// measured from its residuals (Registration::Result::score_covariance).
///
/// After rejected sweeps, tracking has failed. Inertial prediction continues, with zero velocity while the IMU is at
/// rest. Until tracking is restored, each sweep is also registered from several starts around the prediction, coarse to
/// fine. LidarInertialOdometry does not model IMU biases other than the gyro's at the start, loop closure, or moving
/// objects.
class LidarInertialOdometry {
 public:
  using Params = OdometryParams;
  using SweepReport = tumble::SweepReport;

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// Copies the complete state: continuing from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Sets position and heading of the IMU at the start of the map. The tilt is levelled at rest. Covariances are relative
  /// to this pose. Call start_at() before the first sweep. Without start_at(), the map starts at the origin.
  void start_at(const Eigen::Isometry3d& T_WI);
  /// Returns the pose given to start_at(), if any.
  const std::optional<Eigen::Isometry3d>& start() const;

  /// Processes a sample with the angular velocity that a rate method estimated for the sample. On error the state is
  /// unchanged: `non_finite`, `time_order`, or `out_of_range` if `rate` has another time stamp. The first sample after
  /// a gap bridges the gap, with correspondingly larger uncertainty of the prior.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// Sets an odometer's velocity at the start of the next sweep, which is the end of the last sweep. The velocity is in
  /// IMU axes, with its standard deviation per axis. The odometer's velocity replaces the velocity at the end of the
  /// last sweep, for the next sweep only. On error nothing changes: `non_finite`, or `out_of_range` if the standard
  /// deviation is not above 0.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
  /// Sets an odometer's reading for the next sweep. The times of the reading are between the end of the last sweep and
  /// that of the next, with a margin of 20 ms. The reading is fused with the IMU's prediction by covariance
  /// (check_reading). A new reading replaces an earlier one and add_velocity(). A reading that covers other times has
  /// no effect.
  Status add_reading(const OdometerReading& reading);
  /// Marks the accelerometer as unusable within the next sweep. The velocity is predicted as over a gap; the gyro is
  /// used. A call of exclude_force() replaces earlier odometer readings of the sweep.
  void exclude_force();

  /// Registers a sweep of points fired in [start_ns, end_ns]. Sweeps do not overlap. NaN returns are misses.
  ///
  /// Three errors leave the state unchanged. `time_order`: end before start, or start before the last sweep's end.
  /// `too_few`: IMU samples do not cover the sweep. `out_of_range`: an offset beyond the sweep. For unusable points,
  /// the pose is the inertial prediction and the verdict is `rejected`. Errors of points are `empty` (no points),
  /// `non_finite` (no finite point), `too_few` (no point in range) and `degenerate` (all points have one time stamp).
  /// Before the map starts, a sweep with unusable points or with too few points (`too_few`) has no pose: its
  /// `report.trajectory` is empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Predicts pose and velocity with covariance at the last of `samples`, by inertial integration from the last sweep's
  /// end. The samples are not added to the state. Without samples after the last sweep, returns the pose at the sweep's
  /// end. The prediction is useful before a sweep or its rates are available. Errors: `empty` before the first sweep,
  /// and those of add_imu(). Cost: O(samples since the last sweep).
  Status predict(std::span<const ImuSample> samples, std::span<const RateState> rates, PoseState& pose) const;

  /// Returns the current calibration and the covariance of its errors. Parts that are not estimated have their stated
  /// values and covariance 0.
  SweepCalibration calibration() const;
  SweepCalibration::Covariance calibration_covariance() const;
  /// Returns the covariance by which the calibration is weighted against the next sweep. The weighting covariance is
  /// larger than the covariance of the errors because points are correlated and count less. A second run over the
  /// recording starts from the weighting covariance.
  SweepCalibration::Covariance calibration_weight() const;

  /// Returns `out_of_range` while the vertical of the map is uncertain: the standard deviation of gravity's direction
  /// exceeds 0.02 rad. The reason is a start in motion. The finding ends when the motion has determined gravity.
  Status vertical() const;

  /// Returns the pose at any time within the window of sweeps, from all data so far. Returns `out_of_range` for a time
  /// outside of the window.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Returns the current poses of the sweeps in the window, oldest first. Sweeps in the window have no final pose yet.
  /// Together with SweepReport::smoothed, the poses in the window form the whole trajectory.
  std::vector<std::vector<PoseState>> window_trajectories() const;

  /// Returns the memory of the map [bytes].
  std::size_t map_bytes() const;

  /// Returns the map within map_radius_m. Normals are fitted to nearest neighbours and point towards the sensor's
  /// position at the time of observation. Points that two later sweeps saw through are left out, for example people who
  /// moved on. O(number of points).
  std::vector<MapPoint> map() const;

  /// Saves or loads the complete state, except `parallel_for`. The caller must ensure that the loading object has the
  /// parameters of the saving object. The loading object then continues with bit-identical results. Parameters that an
  /// earlier run may have estimated are part of the state (mounting, time offset and their deviations). On error, which
  /// the reader reports, the loading object is unchanged.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  void describe(StateLayout& out) const;

  struct Impl;  ///< used by the library's sources

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
