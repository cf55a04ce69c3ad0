// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tumble/attitude/detail/regime_stream.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {

/// Processes IMU samples and lidar sweeps once, in time order. MotionRegimeStream estimates the angular rates, and
/// LidarInertialOdometry processes samples and sweeps for which rates are available. TumblingOdometry runs one
/// OdometryPass live, and FirstSecondsReprocessing runs a second OdometryPass with the estimated calibration.
class OdometryPass {
 public:
  /// first-in, first-out queue of samples that reuses its memory
  struct WaitingInputQueue {
    std::vector<ImuSample> samples;
    std::size_t head = 0;
    void push(const ImuSample& sample);
    void drop_until(TimeNs time_ns);
    std::span<const ImuSample> all() const { return std::span(samples).subspan(head); }
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  OdometryPass(const MotionRegimeStream::Params& rate, const LidarInertialOdometry::Params& mapping);

  /// Adds an IMU sample. Passes the sample that is lag_s older, with its smoothed angular rate, to the mapper.
  Status add_imu(const ImuSample& sample);
  /// See LidarInertialOdometry::set_start_pose().
  void set_start_pose(const Eigen::Isometry3d& T_WI) { mapper_.set_start_pose(T_WI); }
  /// See LidarInertialOdometry::set_prior_map().
  Status set_prior_map(PriorMap map) { return mapper_.set_prior_map(std::move(map)); }
  void copy_prior_map(const OdometryPass& other) { mapper_.copy_prior_map(other.mapper_); }
  /// Returns whether angular rates are available up to the time `end_ns` of the lidar's clock.
  bool has_rates_until(TimeNs end_ns) const;
  /// Returns the time, in the lidar's clock, up to which angular rates are available. The result is empty if no rates
  /// are available.
  std::optional<TimeNs> covered_ns() const;
  /// Returns the time stamp of the first IMU sample at or after the lidar time `end_ns`, if the rate of this sample is
  /// not yet available.
  std::optional<TimeNs> covering_ns(TimeNs end_ns) const;
  /// `reading` is the odometer reading during the sweep, or empty.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                   const std::optional<OdometerReading>& reading, LidarInertialOdometry::SweepResult& report);
  /// See TumblingOdometry::newest().
  Status newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2) const;

  /// Converts a time from the lidar's clock to the IMU's clock.
  TimeNs oldest_needed_ns(TimeNs lidar_ns) const;
  /// Passes all angular rates up to the first sample at or after `time_ns` to the mapper, without waiting for later
  /// samples.
  void flush_until(TimeNs time_ns);
  /// Restarts the estimation of angular rates with other parameters. The mapper continues without a restart.
  void start_rate_estimation(const MotionRegimeStream::Params& rate);
  /// Replaces the mapper by the mapper of `other`. The rate estimation of this OdometryPass continues unchanged. The
  /// caller must not use `other` afterwards.
  void adopt_map(OdometryPass&& other);

  const MotionRegimeStream& rates() const { return rates_; }
  const MotionRegimeStream::State& rate_stream_state() const { return rate_stream_state_; }
  const LidarInertialOdometry& mapper() const { return mapper_; }
  /// Returns `out_of_range` if the magnitude of the specific force at rest contradicts the magnitude of gravity.
  Status check_force_at_rest() const { return rest_gravity_.gravity_magnitude_verdict(rest_gravity_state_); }
  const LidarScale& lidar_scale() const { return scale_.scale(); }
  const Localisation& localisation() const { return localisation_; }
  const std::optional<AngularRateState>& newest_smoothed_rate() const { return smoothed_; }
  std::size_t samples_rejected_by_mapper() const { return samples_rejected_by_mapper_; }

 private:
  void process_angular_rate(const AngularRateState& rate);

  MotionRegimeStream rates_;
  MotionRegimeStream::State rate_stream_state_;
  LidarInertialOdometry mapper_;
  LidarScaleEstimator scale_;
  Localisation localisation_;
  double time_offset_s_;
  WaitingInputQueue pending_;  ///< samples whose rates are not yet available
  std::optional<AngularRateState> smoothed_;
  std::optional<TimeNs> last_mapped_ns_;  ///< time of the last sample passed to the mapper
  std::size_t samples_rejected_by_mapper_ = 0;
  RestGravity rest_gravity_;
  RestGravity::GravityMagnitudeState rest_gravity_state_;
};

}  // namespace tumble
