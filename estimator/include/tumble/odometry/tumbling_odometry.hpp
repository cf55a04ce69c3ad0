// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/outlier_filter.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/odometry_pass.hpp"
#include "tumble/odometry/detail/second_pass.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/odometry/tumbling_params.hpp"

namespace tumble {

/// Estimates pose, velocity and map of a tumbling body from one IMU, whose gyro may saturate, and a lidar with skewed
/// sweeps. The estimation is causal. SampleClock corrects stamps that a host assigned. RegimeStream estimates each
/// sample's angular velocity with a delay of `lag_s`. LidarInertialOdometry then processes samples and sweeps.
///
/// Three poses of increasing accuracy are reported. newest() predicts the IMU's pose at the newest sample by inertial
/// integration from the last registered sweep. take() returns a sweep registered to the map (`report.pose`), at most
/// lag_s after its end. The next sweep brings its final pose (`report.smoothed`): at most 0.3 s after its end, at ten
/// sweeps per second. Stamps of poses are in the IMU's clock. World: see LidarInertialOdometry; the first sweep with
/// enough points starts the map and has no pose error, and there are no poses before it. Start with at least half a
/// second at rest, which levels the attitude.
///
/// Some seconds after motion starts, SecondPass processes those seconds again with the calibration estimated so far.
/// Map and pose then switch once to its result; earlier poses are not changed. If the lidar is silent for a second,
/// inertial integration continues and reports a sweep without points.
///
/// Cost: an IMU sample costs one step of the stream, and sometimes the registration of a sweep. A sample that ends no
/// sweep allocates nothing after start-up. While the second pass runs, a sweep costs up to four registrations, and once
/// five more at its end. Memory is bounded by the lag, the map radius, `sweeps_max` and the buffer of the second pass,
/// plus 12 bytes per sweep within ten metres. A call needs at most 64 KiB of stack.
///
/// The class uses no threads and no files and prints nothing. Copies contain the complete state, so a run may be split.
/// Not modelled: see RegimeStream and LidarInertialOdometry.
class TumblingOdometry {
 public:
  using Params = TumblingParams;

  /// Result of one sweep.
  struct Sweep {
    Status status;  ///< as LidarInertialOdometry::add_sweep; without a pose, `report.trajectory` is empty
    LidarInertialOdometry::SweepReport report;
  };

  /// Throws InvalidParams if a parameter is out of bounds, the lever arm is not set, or the own-body box is invalid.
  explicit TumblingOdometry(const Params& params);

  /// Processes an IMU sample; stamps must increase. Registers the sweeps whose rates become available. On `non_finite`,
  /// `time_order` or `gap` the state is unchanged, with one exception. The sample after a gap of more than a second
  /// waits for confirmation by the next one. The rates then restart with the current calibration (gaps() counts them),
  /// and the mapper bridges the gap by inertial integration. A single wrong stamp thus costs one sample.
  /// OutlierFilter rejects single wild readings. It may delay a sample by one; newest() is then one sample older.
  Status add_imu(const ImuSample& sample);
  /// Processes a sweep of points fired in [start_ns, end_ns], at any time after its last point. The points are copied.
  /// Points from before the end of the last sweep are dropped because stamps jitter. On error the state is unchanged.
  /// `time_order`: the end is before the start, or half of the sweep is before the end of the last sweep.
  /// `out_of_range`: a point is beyond the sweep, the end is a second after the newest sample, a stamp is beyond 100
  /// years, or too many sweeps wait.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  /// Processes an odometer reading (detail/odometer_reading.hpp). The reading must arrive before its sweep is
  /// registered, which is lag_s after the sweep's end. The last reading of a sweep counts. On error the state is
  /// unchanged: `empty` (no IMU sample yet), `non_finite`, `time_order` (the sweep is already registered),
  /// `out_of_range` (standard deviation not above 0, stamp a second ahead of the newest sample, or 1024 readings wait).
  Status add_velocity(const VelocityReading& velocity);
  Status add_motion(const MotionReading& motion);
  /// Returns the next registered sweep, in order, or nothing.
  std::optional<Sweep> take();
  /// Registers all sweeps that the IMU covers, at the end of a run or during a halt. take() then returns them, and
  /// mapper().open_trajectories() the final poses of sweeps in the window. Later rates restart with the current
  /// calibration.
  void finish();

  /// Predicts pose and velocity of the IMU at its newest sample, with covariance, by inertial integration from the last
  /// registered sweep. Returns `empty` before the first sweep. Allocates; O(samples since the last sweep).
  Status newest(PoseState& pose) const;
  /// Reports whether the inputs and the pose are plausible now. Estimation continues in either case. Returns `ok`, or
  /// `out_of_range` with a finding: a frozen IMU axis and its duration, an inverted accelerometer (FlightSense), a
  /// wrong unit of the accelerometer after a second of rest (RestGravity), a wrong scale of the lidar's ranges
  /// (SweepScale), tracking failure (Localisation, permanent), or too large a change of the lidar's calibration
  /// (GivenCalibration).
  Status doubt() const;
  /// Returns the estimated range scale of the lidar relative to the IMU, as far as the motion determines it.
  const SweepScale& sweep_scale() const { return pass_.sweep_scale(); }
  /// Returns the time of the newest accepted sample.
  std::optional<TimeNs> newest_ns() const { return newest_ns_; }
  /// Returns the rate of the newest sample, if any. While the gyro is saturated, the rate is provisional.
  std::optional<RateState> newest_rate() const { return pass_.rates().rate().newest(pass_.rate_state().rate); }
  /// Returns the latest smoothed rate, about lag_s old. Empty while the lag fills.
  const std::optional<RateState>& smoothed_rate() const { return pass_.smoothed_rate(); }
  /// Returns the estimated calibration of the IMU on the body: lever arm, biases and sensing elements.
  RigCalibration rig() const { return pass_.rates().rate().calibration(pass_.rate_state().rate); }
  const KnownRails& rails() const { return pass_.rate_state().rate.rails.known; }
  /// Returns the number of IMU gaps after which the rates restarted.
  std::size_t gaps() const { return gaps_; }
  /// Returns the number of samples that OutlierFilter rejected because of wild readings or stamps.
  std::size_t rejected_readings() const { return outliers_.rejected; }
  /// Returns whether map and pose are those of the second pass (SecondPass).
  bool passed_again() const { return again_.taken(); }
  /// Return the numbers of samples that the mapper rejected, of sweeps not fetched in time, of sweeps that ended before
  /// the IMU's first sample, and of odometer readings that span two sweeps. All are 0 in normal operation.
  std::size_t refused_samples() const { return pass_.refused_samples(); }
  std::size_t dropped_sweeps() const { return dropped_sweeps_; }
  std::size_t early_sweeps() const { return early_sweeps_; }
  std::size_t unused_readings() const { return readings_.straddling(); }
  /// Returns the standard deviation of the IMU's stamps about a regular clock [s], while stamps are corrected.
  std::optional<double> mended_jitter_s() const;
  /// Returns the mapper: the map and further results.
  const LidarInertialOdometry& mapper() const { return pass_.mapper(); }

  /// Saves the complete state: map, calibration, second pass and sweeps not yet fetched by take(). The bytes are the
  /// same on every machine and include a checksum. An object of the same parameters that loads them continues with
  /// bit-identical results. Two states are equal if their bytes are. Size of a saved map: docs/tutorials/your_robot.md.
  std::vector<std::byte> save() const;
  /// Replaces this state by a saved one. On error this state is unchanged. Errors name the field, the stored value and
  /// the bound: `too_few` (truncated bytes), `non_finite`, `time_order`, `gap`, `out_of_range`. Other parameters,
  /// another library version and damaged bytes are errors, too.
  Status load(std::span<const std::byte> bytes);
  /// Reads the parameters stored in a saved state. On error `params` is unchanged.
  static Status saved_params(std::span<const std::byte> bytes, Params& params);
  /// Visits every member of the state. Defined in the library's sources: state_visitor.hpp.
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
  SampleClock::State stamps_;  ///< of accepted samples
  OdometryPass pass_;
  SecondPass again_;
  std::optional<TimeNs> newest_ns_;      ///< of accepted samples
  std::optional<ImuSample> after_gap_;   ///< first sample after a gap, not yet confirmed
  std::optional<TimeNs> registered_ns_;  ///< end of the last registered sweep; before that, the first sample
  std::size_t gaps_ = 0, dropped_sweeps_ = 0, early_sweeps_ = 0;
  std::deque<WaitingSweep> waiting_;
  WaitingReadings readings_;
  std::deque<Sweep> done_;
  std::optional<TimeNs> sweep_end_ns_;  ///< of the last accepted sweep
};

}  // namespace tumble
