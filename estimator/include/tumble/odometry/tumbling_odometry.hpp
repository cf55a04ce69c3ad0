// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/odometry_pass.hpp"
#include "tumble/odometry/detail/second_pass.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/odometry/tumbling_params.hpp"

namespace tumble {

/// Pose, velocity and map of a body that tumbles, from one IMU whose gyro may clip and a lidar whose sweeps are bent:
/// causal, sample by sample. SampleClock tells when a sample was taken, where a host stamps; RegimeStream gives each
/// sample its angular velocity, clipped or not, when it is `lag_s` old; LidarInertialOdometry takes samples and sweeps
/// as their rates become known.
///
/// Of each sweep there are three words: newest() places the IMU at any time, by inertia from the last sweep that was
/// registered on; take() gives the sweep at most lag_s after its end, registered (`report.pose`); and the sweep after
/// it brings its last word (`report.smoothed`), at ten a second at most 0.3 s after its end. Poses bear times of the
/// IMU's clock and stand in the world of LidarInertialOdometry: z up, origin and yaw at the IMU at the first sample.
/// Begin at rest, half a second or more: it levels the attitude. Once, some seconds after the motion began, map and
/// pose move to where a second pass over those seconds puts them, with the rig and the calibration that they told
/// (SecondPass); poses given out before stay. A lidar that is silent for a second is made up for by inertia, a sweep
/// without points.
///
/// An IMU sample costs one step of the stream, and now and then a sweep's registration; one that ends no sweep
/// allocates nothing once the first have come. While the second pass runs a sweep costs up to four registrations, and
/// five more once, as it catches up. Memory is bounded by the lag, the map's radius, `sweeps_max` and what the second
/// pass remembers, but for 12 bytes a sweep while the body stays within ten metres; a call needs 64 KiB of stack at
/// most. No threads, files, printing. Copies carry all state: runs may be split. Not modelled: see the two classes.
class TumblingOdometry {
 public:
  using Params = TumblingParams;

  /// What became of a sweep.
  struct Sweep {
    Status status;  ///< of LidarInertialOdometry::add_sweep; where it could not be placed `report.trajectory` is empty
    LidarInertialOdometry::SweepReport report;
  };

  /// Throws InvalidParams on a parameter outside of its bound, a lever arm that was not stated and a box of the own
  /// body whose corners are swapped.
  explicit TumblingOdometry(const Params& params);

  /// Takes a sample of the IMU, in order of time. Sweeps whose rates are known with it are registered now. On trouble
  /// (`non_finite`, `time_order`, `gap`) the state is as it was, but that the sample after a gap beyond the stream's
  /// bound, a second, is held back: when the next one bears it out the rates begin anew with what is known of the rig
  /// (gaps() counts), and the mapper bridges the gap by inertia; one stamp that is wrong costs one sample.
  /// OutlierFilter rejects single wild readings. It may hold a sample until the next one comes: newest() is then one
  /// sample older.
  Status add_imu(const ImuSample& sample);
  /// Takes a sweep of points fired in [start_ns, end_ns], at any time after its last point; they are copied. Those from
  /// before the last sweep's end are left out: stamps jitter. Trouble that leaves the state as it was: `time_order` (an
  /// end before its start, or more than half of it before that end), `out_of_range` (the offset of a point beyond the
  /// sweep; an end more than a second after the newest sample; a stamp beyond 100 years; too many that wait). What the
  /// mapper makes: take().
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  /// What an odometer of the robot's says, if it has one (detail/odometer_reading.hpp), before its sweep is registered,
  /// which is lag_s after the sweep's end: of each sweep, from the end of the one before, the last reading counts.
  /// Trouble leaves the state as it was: `empty` (no sample yet), `non_finite`, `time_order` (its sweep is gone),
  /// `out_of_range` (a deviation not above 0, a second ahead of the newest sample, 1024 that wait).
  Status add_velocity(const VelocityReading& velocity);
  Status add_motion(const MotionReading& motion);
  /// The next sweep that was registered, in order; nothing when there is none yet.
  std::optional<Sweep> take();
  /// Settles what there is: at the end of a run, or at a halt. Sweeps that the IMU covers are registered; take() gives
  /// them, and mapper().open_trajectories() the last word of those still in the window. What comes later begins the
  /// rates anew, with what is known of the rig.
  void finish();

  /// Pose and velocity of the IMU at its newest sample, by inertia from the last sweep that was registered, with
  /// covariance. `empty` before that. Allocates; O(samples since then).
  Status newest(PoseState& pose) const;

  /// Whether what it is told can be believed just now: `ok`, or `out_of_range` with the axis of the IMU by name that
  /// has frozen and for how long, with an accelerometer of the other sense (FlightSense), with the scale of the
  /// lidar's ranges where the IMU contradicts it (SweepScale), with what says that it no longer knew where on its map
  /// it was (Localisation), which is for good, or with how far the lidar's calibration moved (GivenCalibration). It
  /// goes on either way: rates that nothing is known of have a wide deviation; a map of another scale is one.
  Status doubt() const;
  /// By how much the lidar's ranges are longer than the IMU has it, as far as the motion told.
  const SweepScale& sweep_scale() const { return pass_.sweep_scale(); }
  /// Time of the newest sample that was taken in.
  std::optional<TimeNs> newest_ns() const { return newest_ns_; }
  /// Rate of the newest sample, if any: provisional where the gyro clips, since what follows tells most of it.
  std::optional<RateState> newest_rate() const { return pass_.rates().rate().newest(pass_.rate_state().rate); }
  /// Latest smoothed rate, lag_s old, or a sample less where a sweep waited for it. Nothing while the lag fills.
  const std::optional<RateState>& smoothed_rate() const { return pass_.smoothed_rate(); }
  /// What is known of the IMU on the body: lever arm, biases, elements.
  RigCalibration rig() const { return pass_.rates().rate().calibration(pass_.rate_state().rate); }
  const KnownRails& rails() const { return pass_.rate_state().rate.rails.known; }
  /// Gaps of the IMU after which the rates began anew.
  std::size_t gaps() const { return gaps_; }
  /// Number of samples that OutlierFilter rejected, because their readings or stamps are wild.
  std::size_t rejected_readings() const { return outliers_.rejected; }
  /// Whether the map and the pose are those of the second pass (SecondPass).
  bool passed_again() const { return again_.taken(); }
  /// Samples that the mapper refused with their rates, sweeps that nobody took in time, an odometer's readings that
  /// reach from one sweep into the next, and are not used: 0 unless something is wrong.
  std::size_t refused_samples() const { return pass_.refused_samples(); }
  std::size_t dropped_sweeps() const { return dropped_sweeps_; }
  std::size_t unused_readings() const { return readings_.straddling(); }
  /// Standard deviation of the IMU's stamps about a regular clock [s], while that clock's times count for them.
  std::optional<double> mended_jitter_s() const;
  /// The map, and all that the mapper tells beside.
  const LidarInertialOdometry& mapper() const { return pass_.mapper(); }

  /// All that it knows, map, rig, second pass and what waits for take() included, as bytes that are the same on every
  /// machine: one of the same parameters that loads them goes on with the same bits. A checksum is with them. Two
  /// states are equal when their bytes are. What a map costs: docs/tutorials/your_robot.md.
  std::vector<std::byte> save() const;
  /// Goes on from where save() was called, in place of what is here. On trouble this is as it was: `too_few` (bytes
  /// that end early), `non_finite`, `time_order`, `gap`, `out_of_range`, with the field, what the bytes say and the
  /// bound. So are parameters that are not those of the state, bytes of another version of the library, damaged ones.
  Status load(std::span<const std::byte> bytes);
  /// The parameters that such bytes are of, to make one of; on trouble `params` are as they were.
  static Status saved_params(std::span<const std::byte> bytes, Params& params);
  /// Stated once, in the library's own sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  Status check_state() const;
  Status add_reading(const OdometerReading& reading);
  Status add_inlier(const ImuSample& sample);
  Status take_in(const ImuSample& sample);
  void register_sweep(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points);
  bool is_due(TimeNs end_ns) const;
  void register_covered();
  void flush_all();
  void begin_anew();
  void begin_rates();

  Params params_;
  OutlierFilter filter_;
  OutlierFilter::State outliers_;
  SampleClock clock_;
  SampleClock::State stamps_;  ///< of the samples taken in
  OdometryPass pass_;
  SecondPass again_;
  std::optional<TimeNs> newest_ns_;      ///< of the samples taken in
  std::optional<ImuSample> after_gap_;   ///< held back
  std::optional<TimeNs> registered_ns_;  ///< end of the last sweep that was registered; the first sample before that
  std::size_t gaps_ = 0, dropped_sweeps_ = 0;
  std::deque<WaitingSweep> waiting_;
  WaitingReadings readings_;
  std::deque<Sweep> done_;
  std::optional<TimeNs> sweep_end_ns_;  ///< of the last sweep taken in
};

}  // namespace tumble
