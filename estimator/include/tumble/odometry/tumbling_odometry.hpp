// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

struct TumblingExpertParams;
extern template class HeapValue<TumblingExpertParams>;

struct TumblingParams {
  static constexpr double kWholeRecording = 1e9;  ///< value of `lag_s`; see TumblingOdometry

  ImuDataSheet imu;
  /// Lever arm from the body's centre of mass to the IMU, in IMU axes, and its standard deviation per axis. In free
  /// flight, the lever arm relates the angular rate to the measured specific force. TumblingOdometry estimates the
  /// error of the stated lever arm. The lever arm is required; zero means that the IMU is at the centre of mass.
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double lever_arm_sigma_m = 0.01;
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  /// Prior standard deviations of the lidar's orientation and position in T_IL, and of the time offset between lidar
  /// and IMU. A standard deviation of 0 means that the stated value is exact and not estimated.
  double mount_sigma_rad = 0.01;
  double mount_sigma_m = 0.006;
  double time_offset_sigma_s = 0.003;
  LidarDataSheet lidar;
  /// Box in lidar axes that contains the robot; lidar returns inside the box are dropped. The default, an empty Eigen
  /// box, keeps all lidar returns. A box with swapped corners is an error.
  Eigen::AlignedBox3d own_body_L;
  std::vector<FurtherLidar> further_lidars;  ///< lidars in addition to the first; see TumblingOdometry::add_sweep()
  double lag_s = 0.2;  ///< delay of reported rates and sweeps: two samples to 10 s, or kWholeRecording

  using Expert = TumblingExpertParams;
  HeapValue<Expert> expert;  ///< rarely changed parameters: odometry/expert_params.hpp

  LidarImuCalibrationPrior lidar_calibration_prior() const {
    LidarImuCalibrationPrior out{{}, mount_sigma_rad, mount_sigma_m, time_offset_sigma_s};
    out.calibration.T_IL = T_IL;
    return out;
  }

  /// Callers of fields() must include odometry/expert_params.hpp.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("imu_", p.imu);
    visit(p.lever_arm_I_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre of mass to the IMU, IMU axes",
                            ParameterAudience::common_use});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 1e-9, 10.0, "standard deviation of the lever arm", ParameterAudience::common_use});
    visit(p.mount_sigma_rad, lidar_calibration_fields::kMountSigmaInfo_rad);
    visit(p.mount_sigma_m, lidar_calibration_fields::kMountSigmaInfo_m);
    visit(p.time_offset_sigma_s, lidar_calibration_fields::kTimeOffsetSigma_s);
    visit.group("", p.lidar);
    visit(p.lag_s, {"lag_s", "s", 0.0, kWholeRecording,
                    "maximum time for which a sweep waits for later data, at most 10 s; a longer time adds delay and "
                    "makes poses more accurate; 1e9: the whole recording",
                    ParameterAudience::common_use});
    visit.group("", *p.expert);
  }
};

class LidarInertialOdometry;
struct WholeRecordingEstimate;
struct SaturationLevels;
struct LidarScale;

/// Estimates pose, velocity and map of a tumbling body from a lidar and one IMU, whose gyro may saturate. SampleClock
/// corrects time stamps that a host computer assigned. MotionRegimeStream estimates the angular velocity at each IMU
/// sample with a delay of `lag_s`.
///
/// TumblingOdometry reports three poses of increasing accuracy. The function newest() predicts the IMU's pose at the
/// newest sample by inertial integration from the last registered sweep. The function take() returns a sweep registered
/// to the map (`result.pose`), at most `lag_s` after the sweep's end. The final pose of a sweep is in the result of the
/// following sweep (`result.final_poses_of_earlier_sweep`). At ten sweeps per second and the default `lag_s`, the final
/// pose is available at most 0.3 s after the end of its sweep. Time stamps of poses are in the IMU's clock. The
/// earliest sweep with enough points starts the map, and poses are reported only after the map has started. Start with
/// at least half a second at rest, which determines the tilt. After a start in free flight or between impacts, the map
/// starts only when the tilt is known, usually at the next rest. A gyro with a bias above 0.05 rad/s needs a full
/// second at rest, because TumblingOdometry then subtracts the bias and restarts.
///
/// Some seconds after motion starts, FirstSecondsReprocessing processes the first seconds of motion again with the
/// calibration estimated so far. If the reprocessing succeeds, TumblingOdometry continues with the map and pose of
/// FirstSecondsReprocessing. The reprocessing does not change poses that were already reported. If no sweep arrives for
/// a second, inertial integration continues the pose, and take() returns a sweep without points.
///
/// With `lag_s` = kWholeRecording, add_imu() and add_sweep() store the data, and finish() estimates rates, poses and
/// map from the whole recording. The function finish() estimates the rates with MotionRegimeSmoother, checks the IMU,
/// and repeats the mapping until the lidar's calibration has converged. With kWholeRecording, there are no live poses,
/// and take() returns all sweeps after finish(). With kWholeRecording, if the clock steps back, add_imu() rejects
/// samples and returns `time_order` until the time stamps exceed the newest accepted time stamp. With kWholeRecording,
/// samples after a gap belong to the same recording as the samples before the gap. With kWholeRecording, finish() needs
/// more stack and memory than other functions.
///
/// An IMU sample costs one step of MotionRegimeStream, and sometimes the registration of a sweep. After start-up,
/// add_imu() allocates memory only if the sample completes a sweep. While FirstSecondsReprocessing runs, a sweep costs
/// up to four registrations. The sweep that completes FirstSecondsReprocessing costs about five additional
/// registrations. The memory of TumblingOdometry is bounded, depending on lag, map radius, `waiting_sweeps_max` and the
/// buffer of FirstSecondsReprocessing. While the robot is localised in a prior map, the memory also grows by 12 bytes
/// per sweep. Without kWholeRecording, each call of a member function needs at most 256 KiB of stack.
///
/// TumblingOdometry starts no threads, uses no files and prints nothing. A copy of a TumblingOdometry contains the
/// complete state, so the copy can continue the run. The limitations of MotionRegimeStream and LidarInertialOdometry
/// apply to TumblingOdometry.
class TumblingOdometry {
 public:
  using Params = TumblingParams;
  using SweepProgress = std::function<void(std::size_t done, std::size_t all)>;
  static constexpr double kWholeRecording = Params::kWholeRecording;  ///< value of Params::lag_s

  struct Sweep {
    Status status;  ///< result of the registration; `result.trajectory` is empty without a pose
    SweepResult result;
    /// Transform from the world to the frame of the position readings, estimated from readings up to the sweep's end.
    /// `position_frame` is empty while the readings do not determine the transform.
    std::optional<PositionFrame> position_frame;
  };

  /// Throws InvalidParams if a parameter is out of bounds, the lever arm is not set, or the box `own_body_L` is
  /// invalid.
  explicit TumblingOdometry(const Params& params);
  TumblingOdometry(const TumblingOdometry& other);
  TumblingOdometry& operator=(const TumblingOdometry& other);
  TumblingOdometry(TumblingOdometry&&) noexcept;
  TumblingOdometry& operator=(TumblingOdometry&&) noexcept;
  ~TumblingOdometry();

  /// Sets the map of an earlier run as prior map, and starts the localisation of the robot in the prior map. Call
  /// set_prior_map() before the first sweep. Until the robot is localised, poses are not in the frame of the prior map,
  /// and health() reports the missing localisation. After localisation, `result.in_prior_map` is true, and poses are in
  /// the frame of the prior map. The function reset() keeps the prior map and localises the robot again. If a prior map
  /// is set, the argument of reset(pose) is a pose in the frame of the prior map. Returns `ok` or an error of
  /// LidarInertialOdometry::set_prior_map().
  Status set_prior_map(PriorMap map);
  /// Processes an IMU sample, and registers each sweep that ended at least `lag_s` before the sample. Time stamps must
  /// increase. Returns `non_finite`, `out_of_range`, `time_order` or `gap` if the sample is rejected. A single wrong
  /// time stamp causes the loss of only one sample. After a gap of more than a second, add_imu() rejects the first
  /// sample and returns `gap`. The second sample after a gap restarts the rate estimation with the current calibration.
  /// Inertial integration bridges gaps. If the clock steps back, add_imu() rejects samples for 0.2 s, returns
  /// `time_order`, and then restarts the run at the newest pose, like reset(pose). OutlierFilter rejects outliers among
  /// the IMU readings. While OutlierFilter checks a sudden change of the readings, one to five samples wait, and
  /// newest() returns the pose before these samples.
  Status add_imu(const ImuSample& sample);
  /// Processes a sweep of points fired in [start_ns, end_ns]. Call add_sweep() after the last point of the sweep; later
  /// IMU samples may be added first. The points are copied. Points that were fired before the end of the last sweep are
  /// dropped, because jitter of the time stamps can make successive sweeps overlap. On error, the state is unchanged.
  /// `time_order` means that `end_ns` is before `start_ns`, or that more than half of the sweep is before the end of
  /// the last sweep. `out_of_range` means that a point was fired outside [start_ns, end_ns], or that `end_ns` is more
  /// than a second after the newest IMU sample. `out_of_range` also means that a time stamp exceeds kStampMax_ns, or
  /// that too many sweeps wait for IMU samples.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  /// Processes a sweep of one of several lidars. For the first lidar, `lidar` is 0; for `further_lidars[k - 1]`,
  /// `lidar` is k. The points of a further lidar are registered together with the simultaneous sweep of the first
  /// lidar. The points of a further lidar must arrive within `lag_s` after the end of the first lidar's sweep. A
  /// `lag_s` of two sweep periods is long enough for lidars without synchronisation. Limitation: the range limits and
  /// the box `own_body_L` of the first lidar also apply to the points of further lidars. Returns `out_of_range` if
  /// `lidar` is larger than the number of further lidars. Further errors are the errors of add_sweep() without the
  /// argument `lidar`.
  Status add_sweep(std::size_t lidar, TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  /// Processes an odometer reading (mapping/types.hpp). An odometer reading must arrive before its sweep is registered,
  /// which happens `lag_s` after the end of the sweep. If several odometer readings belong to one sweep,
  /// TumblingOdometry uses only the last reading. On error, the state is unchanged. Returns `empty` (no IMU sample
  /// yet), `non_finite`, `time_order` (the sweep is already registered) or `out_of_range`. `out_of_range` means an
  /// invalid standard deviation, a time stamp more than a second ahead of the newest sample, or 1024 waiting readings.
  Status add_velocity(const VelocityReading& velocity);
  Status add_relative_pose(const RelativePoseReading& motion);
  /// Processes a position reading, for example from GPS or a beacon. Position readings do not change the poses or the
  /// map. Position readings determine Sweep::position_frame, which transforms poses to a frame without drift. Position
  /// readings may arrive in any order, but each reading must arrive before the sweep at the reading's time is
  /// registered. TumblingOdometry also processes position readings with kWholeRecording. On error, the state is
  /// unchanged. Returns `ok` or an error of add_velocity(); `out_of_range` also means that the covariance is not
  /// symmetric and positive definite.
  Status add_frame_alignment_position(const PositionReading& position);
  /// Returns the oldest registered sweep that take() has not yet returned, or an empty value if there is no such sweep.
  std::optional<Sweep> take();
  /// Registers all waiting sweeps that the IMU samples cover. Call finish() at the end of a run or during a halt. After
  /// finish(), take() returns the registered sweeps. For the last sweeps, mapper().window_trajectories() returns the
  /// final poses instead of `result.final_poses_of_earlier_sweep`. If more samples are added after finish(), the
  /// estimation of angular velocity restarts with the current calibration.
  ///
  /// With kWholeRecording, finish() processes the whole recording, and later samples and sweeps are rejected until
  /// reset(). After finish() with kWholeRecording, take() returns all sweeps with final poses in `result.pose` and
  /// `result.trajectory`. Returns `ok`, an error of AngularRateSmoother::estimate() such as `insufficient_data`, or an
  /// error of the mapper (LidarInertialOdometry). Without kWholeRecording, finish() returns `ok`. For a progress
  /// display, finish() calls `on_sweep` before each sweep, with the numbers of processed sweeps and of all sweeps. At
  /// the start of each pass over the recording, the number of processed sweeps is 0.
  Status finish(const SweepProgress& on_sweep = {});
  /// Starts a new run with a new map, at the origin and at rest. After reset(), take() still returns the remaining
  /// sweeps of the old run, and counters keep their values.
  void reset();
  /// Starts a new run at a known pose of the IMU, like reset(). `T_WI` sets position and heading, and gravity at rest
  /// determines the tilt. Reported covariances describe errors relative to `T_WI`.
  void reset(const Eigen::Isometry3d& T_WI);

  /// Predicts pose and velocity of the IMU at its newest sample, with covariance, by inertial integration from the last
  /// registered sweep. Returns `empty` before the first registered sweep, which starts the map. The function newest()
  /// allocates memory. Cost: O(samples since the last sweep). `velocity_covariance_I_m2_s2` (optional) is the
  /// covariance of the velocity error in IMU axes.
  Status newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;
  /// Reports the suspected faults of the sensors and of the estimate. Estimation continues after any finding. A finding
  /// disappears at most one minute after the fault has ended. The checks are AngularRateStream::health(),
  /// ImuPlausibility, RestGravity, LidarScale, LidarInertialOdometry::check_gravity_direction() and check_localised(),
  /// Localisation and LidarImuCalibrationPrior. With kWholeRecording, finish() checks the whole recording
  /// (detail/imu_findings.hpp), and health() reports no finding before finish(). Cost: a few hundred operations.
  /// Without a finding, health() allocates no memory.
  SensorHealth health() const;
  /// Returns the ratio of displacements measured by the lidar to displacements measured by the IMU, with its standard
  /// deviation (mapping/detail/localisation.hpp).
  const LidarScale& lidar_scale() const;
  /// Returns the newest Sweep::position_frame, which transforms the pose of newest() to the frame of the position
  /// readings. With kWholeRecording, position_frame() returns an empty value.
  const std::optional<PositionFrame>& position_frame() const;
  /// Returns the time of the newest accepted IMU sample.
  std::optional<TimeNs> newest_imu_time_ns() const;
  /// Returns the angular velocity at the newest IMU sample, or an empty value before the first sample. While the gyro
  /// is saturated, the newest angular velocity is provisional.
  std::optional<AngularRateState> newest_rate() const;
  /// Returns the newest smoothed angular velocity, which is about `lag_s` old. Returns an empty value during the first
  /// `lag_s` of a run.
  const std::optional<AngularRateState>& newest_smoothed_rate() const;
  /// Returns the estimated calibration of the IMU on the body (angular_velocity/types.hpp): lever arm, biases,
  /// inertia ratios and gyro axis directions.
  BodyImuCalibration body_imu_calibration() const;
  const SaturationLevels& saturation_levels() const;
  /// Returns the number of restarts after a gap or after a clock that stepped back.
  std::size_t restart_count() const;
  /// Returns the number of samples that OutlierFilter rejected because of a wrong reading or time stamp.
  std::size_t rejected_readings() const;
  /// Returns true if FirstSecondsReprocessing has replaced the map and the pose.
  bool first_seconds_reprocessing_applied() const;
  /// Returns the number of IMU samples that the mapper rejected; 0 in normal operation.
  std::size_t samples_rejected_by_mapper() const;
  /// Returns the number of sweeps that were dropped because take() was not called in time; 0 in normal operation.
  std::size_t dropped_untaken_sweeps() const;
  /// Returns the number of sweeps that ended before the first IMU sample; 0 in normal operation.
  std::size_t sweeps_before_first_imu() const;
  /// Returns the jitter of the IMU's time stamps about a regular clock [s] while SampleClock corrects the time stamps,
  /// and otherwise an empty value.
  std::optional<double> estimated_jitter_s() const;
  /// Returns the mapper (mapping/lidar_inertial_odometry.hpp), which provides the map and the calibration of the lidar.
  const LidarInertialOdometry& mapper() const;
  /// Returns the angular velocities at all samples, the health findings, and the results of the mapping for a whole
  /// recording (detail/mapping_passes.hpp). Returns null before finish(), or if `lag_s` is not kWholeRecording.
  const WholeRecordingEstimate* whole_recording_result() const;

  /// Saves calibration, saturation limits, map and newest pose as bytes with a checksum, for load() after a reboot. The
  /// calibration consists of body_imu_calibration(), the detected delay and errors of the IMU, and pose and time offset
  /// of the lidar, each with its uncertainty. The saved map has the format of save_map(). Every machine saves numbers
  /// in little-endian order. Before the robot is localised in a prior map, save() saves the prior map.
  ///
  /// The saved bytes contain no velocity, filter states, health findings, counters, odometer readings, position
  /// readings, or buffer of FirstSecondsReprocessing. The saved bytes also omit sweeps that wait for IMU samples or for
  /// take(). With kWholeRecording, the saved bytes contain the results of finish(), without the recorded data.
  std::vector<std::byte> save() const;
  /// Starts a new run from the bytes that save() returned, and discards the previous state of the object. The saved
  /// calibration replaces the calibration in the parameters, also after a later reset(). The saved biases get the
  /// uncertainty of the prior, because biases change at every switch-on. If at least 100 points of the saved map have
  /// normals, load() calls set_prior_map() with the saved map. The new run starts at the saved pose and localises the
  /// robot around this pose. Until the robot is localised, health() reports the missing localisation. If the robot may
  /// have moved by more than a metre since save(), call reset(pose) after load(). With kWholeRecording, the new run
  /// starts at the saved pose with a new map.
  ///
  /// `last_pose` receives the saved pose with its time in the clock of the saved run. If no pose was saved, `last_pose`
  /// is empty. If load() returns an error, the object is unchanged, and the returned status names the field, the saved
  /// value and the bound. The error is `insufficient_data` (truncated bytes), `non_finite`, `degenerate` or
  /// `out_of_range`. The function load() rejects damaged bytes, and bytes that another version or a RollingOdometry
  /// saved. A saved run with another stated lever arm or lidar mounting is also rejected.
  Status load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose = nullptr);

  struct Impl;  ///< private implementation

 private:
  HeapValue<Impl> impl_;
};

/// Converts map points to bytes: position, normal and standard deviation of each point, in the order of `points`. The
/// saved bytes also contain the version of the format, the number of points and a checksum. Every machine saves numbers
/// in little-endian order. Each saved point needs 28 bytes. Cost: O(points).
std::vector<std::byte> save_map(std::span<const MapPoint> points);

/// Reads map points from the bytes that save_map() returned, for LidarInertialOdometry::set_prior_map(). If load_map()
/// returns an error, `points` is unchanged, and the returned status names the field, the value and the bound. The error
/// `insufficient_data` means truncated bytes. The errors `non_finite` and `out_of_range` mean damaged bytes, bytes
/// without a map, another format version, or points that check_map_points() rejects.
Status load_map(std::span<const std::byte> bytes, std::vector<MapPoint>& points);

}  // namespace tumble
