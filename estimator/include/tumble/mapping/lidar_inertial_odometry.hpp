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

/// Lidar-inertial odometry and mapping of a body that tumbles: integrates the IMU between sweeps, deskews each point at
/// its own time, registers the sweep to a voxel map by k-nearest-neighbour point-to-plane, and extends the map.
/// Position, attitude and velocity at the start of a sweep are refined together, so that the deskewing is refined too.
///
/// World: z up, levelled by the specific force at rest. The first sweep with `matches_min` points starts the map. If it
/// starts within half a second of the IMU, origin and yaw are at the IMU at the first sample. Otherwise they are at the
/// IMU at the start of that sweep, whose velocity and tilt come from dead reckoning.
/// Feed IMU samples in time order, then each sweep once IMU samples reach its end. No threads of its own, no files, no
/// printing. Where their standard deviation is not 0, the lidar's mounting, its clock and gravity are estimated with
/// the motion, as one state with one covariance: an iterated error-state filter over sweeps, whose last window_sweeps
/// are smoothed by those that follow (fixed lag), with what they drew into the map. Beyond the window the map stays
/// where it was put: a caller that keeps its recording runs a second time from calibration() and gets a map of one
/// piece.
///
/// Covariances reported follow the errors through the filter's weights, the registration's share as measured from its
/// residuals (Registration::Result::score_covariance).
///
/// After rejected sweeps the sensor is lost: the inertial prior goes on, with velocity zero while the IMU rests, and
/// each further sweep is also tried against the map from starts around the prior, coarse to fine. Not modelled: biases
/// of the IMU but the gyro's at the start, loop closure, moving objects.
class LidarInertialOdometry {
 public:
  using Params = OdometryParams;
  using SweepReport = tumble::SweepReport;

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// Copies carry all state: continuing from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Adds a sample with the angular velocity that a rate method gave for it. On trouble the state is unchanged:
  /// `non_finite`, `time_order`, or `out_of_range` when `rate` belongs to another time. A gap is bridged by the sample
  /// after it, and the prior loosened accordingly.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// What an odometer says of the velocity at the start of the next sweep, which is where the last one ended: in IMU
  /// axes, and its standard deviation per axis. It takes the place of the velocity that the last sweep ended with, for
  /// that one sweep. `non_finite`, or `out_of_range` where the standard deviation is not above 0; nothing is changed.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
  /// What an odometer says of the motion within the next sweep, from where the last one ended to its end and 20 ms
  /// about it, to be weighed against what the IMU tells (check_reading); in the place of add_velocity, or of one
  /// before. One of another time changes nothing.
  Status add_reading(const OdometerReading& reading);
  /// What the accelerometer reads within the next sweep is of no use: the velocity goes on as over a gap, and the gyro
  /// counts. In the place of what was said of that sweep before.
  void leave_out_force();

  /// Registers a sweep of points fired in [start_ns, end_ns]; sweeps do not overlap. Returns that are NaN are misses.
  ///
  /// Trouble that leaves the state as it was: `time_order` (end before start, or start before the last sweep's end),
  /// `too_few` (IMU samples do not cover the sweep), `out_of_range` (an offset beyond the sweep).
  /// Trouble after which the pose is the inertial prior and the verdict `rejected`: `empty` (no points), `non_finite`
  /// (no finite point), `too_few` (none in range), `degenerate` (all points bear one time stamp though the sweep
  /// lasts). Before the map starts, a sweep with such trouble or with too few points (`too_few`) has no pose: the
  /// trajectory of its report is empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Pose and velocity at the last of further samples, which are not added: from the last sweep's end by inertia alone,
  /// with covariance; there where nothing came after it. For who needs a pose before the sweep is there, or its rates
  /// are known. Trouble: `empty` before the first sweep, and that of add_imu. O(samples since the last sweep).
  Status predict(std::span<const ImuSample> samples, std::span<const RateState> rates, PoseState& pose) const;

  /// Calibration as estimated so far, and the covariance of its errors; the given one, and 0, where not estimated.
  SweepCalibration calibration() const;
  SweepCalibration::Covariance calibration_covariance() const;
  /// What weighs the calibration against the next sweep, wider than its errors since a point counts for less than it
  /// tells: what another run over the same data starts from.
  SweepCalibration::Covariance calibration_weight() const;

  /// Pose at any time within the window of sweeps, by all that has been seen. `out_of_range` outside of it.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Poses of the sweeps in the window that have not had their last word yet, as they stand, oldest first: with
  /// SweepReport::smoothed, the whole trajectory.
  std::vector<std::vector<PoseState>> open_trajectories() const;

  /// Memory held by the map [bytes].
  std::size_t map_bytes() const;

  /// The map within map_radius_m, with normals from the nearest neighbours that look towards where the point was seen
  /// from; without what two sweeps saw through since (people who went on). O(number of points).
  std::vector<MapPoint> map() const;

  /// All of it but what the caller gave for its work (`parallel_for`), into one of the same parameters: a state that
  /// was loaded goes on with the same bits. What another run may have taught of the parameters (the mounting, the
  /// clock, their deviations) comes with it; that the others are the same is for the caller to see to. On trouble,
  /// which the reader tells, this is as it was.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  void describe(StateLayout& out) const;

  struct Impl;  ///< for the library's own sources

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
