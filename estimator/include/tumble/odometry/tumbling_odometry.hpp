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

/// Estimates pose, velocity and map of a tumbling body from one IMU, whose gyro may saturate, and a lidar with skewed
/// sweeps. The estimation is causal. SampleClock corrects time stamps that a host computer assigned. RegimeStream
/// estimates the angular velocity of each sample with a delay of `lag_s`. LidarInertialOdometry then processes the
/// samples and the sweeps.
///
/// TumblingOdometry reports three poses of increasing accuracy. The function newest() predicts the IMU's pose at the
/// newest sample by inertial integration from the last registered sweep. The function take() returns a pose registered
/// to the map (`report.pose`), at most lag_s after the end of the sweep. The report of the following sweep contains the
/// final pose (`report.smoothed`). With ten sweeps per second, the final pose is available at most 0.3 s after the end
/// of its sweep. The time stamps of poses are in the IMU's clock. The axes of the world are those of
/// LidarInertialOdometry. The earliest sweep with enough points starts the map, and its pose is exact by definition.
/// Before the map starts, TumblingOdometry reports no poses. The body should be at rest for at least half a second at
/// the start, so that the attitude can be levelled.
///
/// Some seconds after motion starts, SecondPass processes the first seconds of motion again with the calibration
/// estimated so far. TumblingOdometry then continues with the map and pose of SecondPass; poses that were already
/// reported are not changed. If no sweep arrives for a second, inertial integration continues, and take() returns a
/// sweep without points.
///
/// An IMU sample costs one step of RegimeStream, and sometimes the registration of a sweep. After start-up, a sample
/// that ends no sweep allocates no memory. While SecondPass runs, a sweep costs up to four registrations. The end of
/// SecondPass costs five more registrations. The lag, the map radius, `sweeps_max` and the buffer of SecondPass limit
/// the memory. In addition, the map stores 12 bytes per sweep within ten metres. A call needs at most 64 KiB of stack.
///
/// TumblingOdometry uses no threads and no files and prints nothing. A copy of a TumblingOdometry contains the complete
/// state, so a run can be split. The limitations of RegimeStream and LidarInertialOdometry apply to TumblingOdometry.
class TumblingOdometry {
 public:
  using Params = TumblingParams;

  /// Sweep is the result of one sweep.
  struct Sweep {
    Status status;  ///< status of add_sweep(); without a pose, `report.trajectory` is empty
    LidarInertialOdometry::SweepReport report;
  };

  /// Throws InvalidParams if a parameter is out of bounds, the lever arm is not set, or the own-body box is invalid.
  explicit TumblingOdometry(const Params& params);

  /// Processes an IMU sample; time stamps must increase. The function registers the sweeps whose rates become
  /// available. If add_imu() returns `non_finite`, `time_order` or `gap`, the state is unchanged, except for a sample
  /// after a gap. The first sample after a gap of more than a second waits until the next sample confirms its time
  /// stamp. After a confirmed gap, the rate estimation restarts with the current calibration, and the mapper bridges
  /// the gap by inertial integration. The function gaps() counts the restarts. A single sample with a wrong time stamp
  /// is therefore lost without a restart. OutlierFilter rejects single wild readings. OutlierFilter may delay a sample
  /// by one sample; newest() then returns the pose of the previous sample.
  Status add_imu(const ImuSample& sample);
  /// Processes a sweep of points fired in [start_ns, end_ns], at any time after the sweep's last point. The function
  /// copies the points. Points from before the end of the last sweep are dropped, because time stamps of sweeps may
  /// overlap by jitter. On error the state is unchanged. The error `time_order` means that the end is before the start,
  /// or that half of the sweep is before the end of the last sweep. The error `out_of_range` means that a point is
  /// beyond the sweep, or that the end is a second after the newest IMU sample. A stamp beyond 109 years, or too many
  /// waiting sweeps, also return `out_of_range`.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  /// Processes an odometer reading (detail/odometer_reading.hpp). The reading must arrive before its sweep is
  /// registered, which happens lag_s after the end of the sweep. If a sweep has several odometer readings, only the
  /// last reading is used. On error the state is unchanged. Returns `empty` (no IMU sample yet), `non_finite`,
  /// `time_order` (the sweep is already registered) or `out_of_range` on error. The error `out_of_range` means that the
  /// standard deviation is not above 0, or that the stamp is a second ahead of the newest sample. If 1024 readings
  /// wait, the functions also return `out_of_range`.
  Status add_velocity(const VelocityReading& velocity);
  Status add_motion(const MotionReading& motion);
  /// Returns the next registered sweep, in time order. The result is empty if no registered sweep waits.
  std::optional<Sweep> take();
  /// Registers all sweeps that the IMU samples cover, at the end of a run or during a halt. After finish(), take()
  /// returns the registered sweeps. The final poses of the sweeps that are still in the window are available from
  /// mapper().window_trajectories(). If more samples are added after finish(), the rate estimation restarts with the
  /// current calibration.
  void finish();

  /// Predicts pose and velocity of the IMU at its newest sample, with covariance, by inertial integration from the last
  /// registered sweep. Returns `empty` before the first sweep. The function newest() allocates memory. Cost: O(samples
  /// since the last sweep).
  Status newest(PoseState& pose) const;
  /// Reports whether inputs and pose are currently plausible. Estimation continues after any finding of health().
  /// Returns `ok`, or `out_of_range` with one finding. A finding of health() can be a frozen axis of the IMU, with the
  /// duration of the freeze. A finding of health() can be an accelerometer with inverted sign (FlightSense), or with a
  /// wrong unit after a second of rest (RestGravity). A finding of health() can be a wrong scale of the lidar's ranges
  /// (SweepScale), or too large a change of the lidar's calibration (StatedCalibration). A tracking failure
  /// (Localisation) is reported by health() until the end of the run.
  Status health() const;
  /// Returns the estimated scale of the lidar's ranges relative to the IMU, as far as the motion determines the scale.
  const SweepScale& sweep_scale() const { return pass_.sweep_scale(); }
  /// Returns the time of the newest accepted IMU sample.
  std::optional<TimeNs> newest_ns() const { return newest_ns_; }
  /// Returns the rate of the newest IMU sample, if any. While the gyro is saturated, the rate of the newest sample is
  /// provisional.
  std::optional<RateState> newest_rate() const { return pass_.rates().rate().newest(pass_.rate_state().rate); }
  /// Returns the latest smoothed rate, which is about lag_s old. The result is empty while the lag fills.
  const std::optional<RateState>& smoothed_rate() const { return pass_.smoothed_rate(); }
  /// Returns the estimated calibration of the IMU on the body: lever arm, biases, inertia and sensing directions.
  RigCalibration rig() const { return pass_.rates().rate().calibration(pass_.rate_state().rate); }
  const KnownRails& rails() const { return pass_.rate_state().rate.rails.known; }
  /// Returns the number of IMU gaps after which the rate estimation restarted.
  std::size_t gaps() const { return gaps_; }
  /// Returns the number of samples that OutlierFilter rejected because of wild readings or time stamps.
  std::size_t rejected_readings() const { return outliers_.rejected; }
  /// Returns whether SecondPass has replaced map and pose.
  bool second_pass_applied() const { return second_pass_.taken(); }
  /// The counters rejected_samples(), dropped_sweeps(), early_sweeps() and unused_odometer_readings() are 0 in normal
  /// operation.
  /// The function rejected_samples() counts IMU samples that the mapper rejected.
  /// The function dropped_sweeps() counts sweeps that take() did not return in time.
  /// The function early_sweeps() counts sweeps that ended before the first IMU sample.
  /// The function unused_odometer_readings() counts odometer readings that span two sweeps.
  std::size_t rejected_samples() const { return pass_.rejected_samples(); }
  std::size_t dropped_sweeps() const { return dropped_sweeps_; }
  std::size_t early_sweeps() const { return early_sweeps_; }
  std::size_t unused_odometer_readings() const { return readings_.straddling(); }
  /// Returns the standard deviation of the IMU's time stamps about a regular clock [s], while SampleClock corrects the
  /// stamps.
  std::optional<double> estimated_jitter_s() const;
  /// Returns the mapper, which provides the map and the calibration of the lidar.
  const LidarInertialOdometry& mapper() const { return pass_.mapper(); }

  /// Saves the complete state: map, calibration, SecondPass, and sweeps that take() has not yet returned. The saved
  /// bytes are equal on every machine and include a checksum. If an object with equal parameters loads the bytes, the
  /// object continues with bit-identical results. Two states are equal if their saved bytes are equal. The size of a
  /// saved map is in docs/tutorials/your_robot.md.
  std::vector<std::byte> save() const;
  /// Replaces the state by a saved state. On error the state is unchanged. The returned status names the field, the
  /// stored value and the bound. The error is `too_few` (truncated bytes), `non_finite`, `time_order`, `gap` or
  /// `out_of_range`. The function also rejects a state with different parameters, a different library version, or
  /// damaged bytes.
  Status load(std::span<const std::byte> bytes);
  /// Reads the parameters that a saved state contains. On error `params` is unchanged.
  static Status saved_params(std::span<const std::byte> bytes, Params& params);
  /// Passes every member of the state to the visitor. The source file state_visitor.hpp defines the function.
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
  void restart();
  void begin_rates();

  Params params_;
  OutlierFilter filter_;
  OutlierFilter::State outliers_;
  SampleClock clock_;
  SampleClock::State stamps_;  ///< state of the clock from accepted samples
  OdometryPass pass_;
  SecondPass second_pass_;
  std::optional<TimeNs> newest_ns_;      ///< time of the newest accepted sample
  std::optional<ImuSample> after_gap_;   ///< first sample after a gap, not yet confirmed
  std::optional<TimeNs> registered_ns_;  ///< end of the last registered sweep, else time of the first sample
  std::size_t gaps_ = 0, dropped_sweeps_ = 0, early_sweeps_ = 0;
  std::deque<WaitingSweep> waiting_;
  WaitingReadings readings_;
  std::deque<Sweep> done_;
  std::optional<TimeNs> sweep_end_ns_;  ///< end of the last accepted sweep
};

}  // namespace tumble
