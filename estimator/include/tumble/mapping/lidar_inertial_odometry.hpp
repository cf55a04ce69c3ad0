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
#include "tumble/mapping/detail/prior_map.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/odometry_params.hpp"
#include "tumble/mapping/sweep_report.hpp"

namespace tumble {

class StateWriter;
class StateReader;
class StateLayout;

/// Estimates pose and map of a tumbling body from an IMU and a lidar. LidarInertialOdometry integrates the IMU between
/// sweeps, and deskews each point at the time of its firing. Each sweep is registered to a voxel map by
/// k-nearest-neighbour point-to-plane distances, and then extends the map. The registration refines position, attitude
/// and velocity at the start of a sweep together. The refined velocity also improves the deskewing.
///
/// The world has its z axis up, levelled by the specific force at rest. The earliest sweep with `matches_min` points
/// starts the map. Origin and yaw of the world are those of the IMU at its first sample, if the map starts within half
/// a second. If the map starts later than half a second after the first sample, origin and yaw are those of the IMU at
/// the map's first sweep. If the map starts later, dead reckoning from the first IMU sample gives the velocity and the
/// tilt. Pass IMU samples in time order, and pass each sweep when the IMU samples reach the end of the sweep.
/// LidarInertialOdometry starts no threads, uses no files and prints nothing.
///
/// The lidar's mounting, its time offset and gravity are estimated if their standard deviations are not 0. All unknowns
/// form one state with one covariance. LidarInertialOdometry is an iterated error-state filter over sweeps. A fixed-lag
/// smoother refines the last window_sweeps sweeps with the data of later sweeps, and moves the map points of the
/// refined sweeps. Map points of sweeps older than the window are not moved. To get a consistent map, a caller can
/// process its recording a second time, starting from calibration().
///
/// The reported covariances propagate the errors through the gains of the filter. The residuals of the registration
/// determine its contribution to the covariance (Registration::Result::score_covariance).
///
/// Tracking has failed if several sweeps in succession are rejected. After a tracking failure, inertial prediction
/// continues, with zero velocity while the IMU is at rest. Until tracking is restored, each sweep is also registered
/// from several starting poses around the prediction, coarse to fine. LidarInertialOdometry does not model loop
/// closure, moving objects, or IMU biases other than the gyro bias at the start.
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

  /// Sets position and heading of the IMU at the start of the map. The tilt is levelled at rest. Covariances are
  /// relative to this pose. Call set_start_pose() before the first sweep. Without set_start_pose(), the map starts at
  /// the origin.
  void set_start_pose(const Eigen::Isometry3d& T_WI);
  /// Returns the pose given to set_start_pose(), if any.
  const std::optional<Eigen::Isometry3d>& start() const;

  /// Correction of the attitude at a start in motion, where the mean force is not gravity.
  struct StartTilt {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< corrects the attitude of the levelled start
    double sigma_rad = 0.0;                                        ///< standard deviation of the corrected tilt

    template <class Self, class Visitor>
    static void members(Self& s, Visitor& visit);
  };
  /// Returns the tilt of the start according to gravity in the map, for another run over the same data. The result is
  /// empty after a start at rest, or if the motion does not determine gravity better than the start.
  std::optional<StartTilt> start_tilt() const;
  /// Sets the tilt of a start in motion. Call set_start_tilt() before the first sweep.
  void set_start_tilt(const StartTilt& tilt);

  /// Sets the map of an earlier run, in which the run localises itself. Call use_map() before the first sweep.
  ///
  /// Until the run is localised, poses are in a local frame, and localised() returns `degenerate`. The local map is
  /// compared with the prior map after each registered sweep. When a pose is accepted, the state continues in the frame
  /// of the prior map: SweepReport::in_prior_map is true, and covariances are relative to the prior map. If `map.T_MI`
  /// is set, use_map() also calls set_start_pose(). The prior map is kept as a whole, also beyond map_radius_m.
  /// Returns the errors of check_prior_map(), or `time_order` after the first sweep. On error nothing changes.
  Status use_map(PriorMap map);
  /// Uses the prior map of another object, if any, with its parameters. The localisation starts again, from the pose
  /// given to set_start_pose(), or else from the pose given with the map.
  void use_map_of(const LidarInertialOdometry& other);
  /// Returns ok if the run is localised in the prior map or if there is no prior map, and `degenerate` otherwise.
  Status localised() const;
  bool has_prior_map() const;

  /// Processes a sample with the angular velocity that a rate method estimated for the sample. On error the state is
  /// unchanged: `non_finite`, `time_order`, or `out_of_range` if `rate` has another time stamp. The first sample after
  /// a gap bridges the gap, with correspondingly larger uncertainty of the prior.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// Sets an odometer's velocity at the start of the next sweep, which is the end of the last sweep. The velocity is in
  /// IMU axes, with one standard deviation for all axes. The odometer's velocity replaces the estimated velocity at the
  /// end of the last sweep, for the prediction of the next sweep only. Returns `non_finite`, or `out_of_range` if the
  /// standard deviation is not above 0. On error nothing changes.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
  /// Sets an odometer's reading for the next sweep. The reading must be between the end of the last sweep and the end
  /// of the next sweep, with a margin of 20 ms. The reading is fused with the IMU's prediction, weighted by the
  /// covariances (check_reading). A new reading replaces an earlier reading and the velocity of add_velocity(). A
  /// reading that does not cover the next sweep has no effect.
  Status add_reading(const OdometerReading& reading);
  /// Excludes the accelerometer from the prediction of the next sweep. Without the accelerometer, the velocity is
  /// predicted as in a gap; the gyro is still used. A call of exclude_accelerometer() replaces earlier odometer
  /// readings for the next sweep.
  void exclude_accelerometer();

  /// Registers a sweep of points fired in [start_ns, end_ns]. Sweeps must not overlap. Points with NaN coordinates are
  /// misses.
  ///
  /// Three errors of add_sweep() leave the state unchanged. `time_order` means that the end is before the start, or
  /// that the start is before the end of the last sweep. `too_few` means that the IMU samples do not cover the sweep.
  /// `out_of_range` means that the firing time of a point is beyond the sweep. If the points are unusable, the pose is
  /// the inertial prediction and the verdict is `rejected`. For unusable points, the status is `empty` (no points),
  /// `non_finite` (no finite point), `too_few` (no point in range) or `degenerate` (one time stamp). Before the map
  /// starts, a sweep with unusable points or too few points has no pose, and `report.trajectory` is empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Predicts pose and velocity with covariance at the last of `samples`, by inertial integration from the end of the
  /// last sweep. The function does not add the samples to the state. If no sample is later than the last sweep,
  /// predict() returns the pose at the end of the last sweep. A caller needs predict() before a sweep or its rates are
  /// available. Returns the errors of add_imu(), or `empty` before the first sweep. Cost: O(samples since the last
  /// sweep). `velocity_covariance_I_m2_s2` receives the covariance of SweepReport with this name, unless null.
  Status predict(std::span<const ImuSample> samples, std::span<const RateState> rates, PoseState& pose,
                 Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;

  /// Returns the current calibration and the covariance of its errors. Parts of the calibration that are not estimated
  /// have their stated values and covariance 0.
  SweepCalibration calibration() const;
  SweepCalibration::Covariance calibration_covariance() const;
  /// Returns the covariance with which the calibration is weighted against the next sweep. The weighting covariance is
  /// larger than the covariance of the errors, because points are correlated and therefore weighted less. A second run
  /// over the recording starts from the weighting covariance.
  SweepCalibration::Covariance calibration_weighting_covariance() const;

  /// Returns `out_of_range` while the vertical of the map is uncertain: the standard deviation of gravity's direction
  /// exceeds 0.02 rad. The reason is a start in motion. The finding ends when the motion has determined gravity.
  Status check_vertical() const;

  /// Returns the pose at any time within the window of sweeps, from all data so far. Returns `out_of_range` for a time
  /// outside of the window.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Returns the current poses of the sweeps in the window, oldest first. Poses of sweeps in the window are not final
  /// yet. SweepReport::smoothed and window_trajectories() together form the whole trajectory.
  std::vector<std::vector<PoseState>> window_trajectories() const;

  /// Returns the memory that the map uses [bytes].
  std::size_t map_bytes() const;

  /// Returns the map points within map_radius_m. Cost: O(number of points). Normals are fitted to nearest neighbours,
  /// and point towards the position from which the sensor observed the point. The function omits points that two later
  /// sweeps saw through, for example points on people who moved on.
  std::vector<MapPoint> map() const;

  /// Save or load the complete state, except `parallel_for`. The caller must ensure that the loading object has the
  /// parameters of the saving object. A loading object with equal parameters continues with bit-identical results. The
  /// saved state contains mounting, time offset and their standard deviations, because an earlier run may have
  /// estimated the calibration. If loading fails, the StateReader reports an error and the loading object is unchanged.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  void describe(StateLayout& out) const;

  struct Impl;  ///< used by the library's sources

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
