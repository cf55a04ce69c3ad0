// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/attitude/regime_stream.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {

/// One pass over the samples of an IMU and the sweeps of a lidar, in order of time: RegimeStream gives the rates,
/// LidarInertialOdometry takes them and the sweeps that they cover. What TumblingOdometry does live, and once more
/// with what it learnt (SecondPass). Copies carry all state.
class OdometryPass {
 public:
  /// Samples, first in, first out, in memory that is kept.
  struct Queue {
    std::vector<ImuSample> samples;
    std::size_t head = 0;
    void push(const ImuSample& sample);
    void drop_until(TimeNs time_ns);
    std::span<const ImuSample> all() const { return std::span(samples).subspan(head); }
    template <class Self, class Visitor>
    static void members(Self& s, Visitor& visit);
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  OdometryPass(const RegimeStream::Params& rate, const LidarInertialOdometry::Params& mapping);

  /// As RegimeStream::push; the rate that is given out with the sample goes to the mapper.
  Status add_imu(const ImuSample& sample);
  /// Whether the rates are given out up to this time of the lidar's clock.
  bool covers(TimeNs end_ns) const;
  /// The same for the newest of them, by the lidar's clock. Nothing before the first.
  std::optional<TimeNs> covered_ns() const;
  /// The first sample, by the IMU's clock, that covers this time of the lidar's and whose rate is not given out yet.
  std::optional<TimeNs> covering_ns(TimeNs end_ns) const;
  /// `reading`: of the sweep, if there is one.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                   const std::optional<OdometerReading>& reading, LidarInertialOdometry::SweepReport& report);
  /// As TumblingOdometry::newest.
  Status newest(PoseState& pose) const;

  /// The time of the IMU's clock that is a time of the lidar's.
  TimeNs needed_ns(TimeNs lidar_ns) const;
  /// Gives out the rates up to the first sample at or after a time as they stand, though less than the lag lies ahead.
  void flush_until(TimeNs time_ns);
  /// The rates go on with another stream, anew; the mapper stays.
  void begin_rates(const RegimeStream::Params& rate);
  /// The map and all that hangs on it is that of another pass, with the memory that it keeps for its samples; the rates
  /// stay, and go on where that one was told last. The other is spent.
  void take_map(OdometryPass&& other);

  const RegimeStream& rates() const { return rates_; }
  const RegimeStream::State& rate_state() const { return rate_state_; }
  const LidarInertialOdometry& mapper() const { return mapper_; }
  /// `out_of_range` where gravity contradicts the force at rest.
  Status force_at_rest() const { return gravity_.size_verdict(gravity_state_); }
  const SweepScale& sweep_scale() const { return scale_.scale(); }
  const Localisation& localisation() const { return localisation_; }
  const std::optional<RateState>& smoothed_rate() const { return smoothed_; }
  std::size_t refused_samples() const { return refused_samples_; }

  /// Stated once, in the library's own sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);
  /// What holds between the members of every state; the first that does not.
  Status check_state() const;

 private:
  void take_rate(const RateState& rate);

  RegimeStream rates_;
  RegimeStream::State rate_state_;
  LidarInertialOdometry mapper_;
  SweepScaleWatch scale_;
  Localisation localisation_;
  double rate_sigma_max_rad_s_, time_offset_s_;
  Queue pending_;  ///< samples whose rates are not given out yet
  std::optional<RateState> smoothed_;
  std::optional<TimeNs> told_ns_;  ///< of the last sample that the mapper was given
  std::size_t refused_samples_ = 0;
  RestGravity gravity_;
  RestGravity::Size gravity_state_;
};

}  // namespace tumble
