// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "odometry_pass.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/odometry/expert_params.hpp"

namespace tumble {

/// Processes the first seconds of motion again with the estimated calibration, while the first pass continues.
///
/// During the first pass, lever arm, lidar mounting and time offset are still uncertain at the start of a tumble, which
/// falsifies the map. FirstSecondsReprocessing therefore buffers IMU samples and sweeps, starting about 1 s before the
/// end of the initial rest. After `after_motion_s` of motion, the second pass processes the buffer with the estimated
/// calibration, and with angular rates smoothed with a lag of `rate_lag_s`. The second pass processes three buffered
/// sweeps per new sweep. When the second pass ends, its map and pose replace the map and pose of the first pass. The
/// results of the second pass are discarded if the second pass rejected clearly more sweeps than the first pass. The
/// results of the second pass are also discarded if only the second pass rejected the last sweep.
///
/// If tracking of the first pass has failed for `tracking_failure_s`, an additional early second pass starts
/// immediately, at most once. FirstSecondsReprocessing does not change previously reported poses, so the reported pose
/// jumps by the error of the first pass.
///
/// FirstSecondsReprocessing stores samples and sweeps of about 1 s at rest and of at most 10 s of motion. The second
/// pass also needs memory for a second map. If a jolt ends the initial rest long before the tumble, the second pass
/// starts too early.
class FirstSecondsReprocessing {
 public:
  using Params = FirstSecondsReprocessingParams;

  /// `rate` and `mapping` are the parameters of the first pass. Throws InvalidParams if a parameter is out of bounds.
  FirstSecondsReprocessing(const Params& params, const MotionRegimeStream::Params& rate,
                           const LidarInertialOdometry::Params& mapping);

  /// Sets the gyro's zero offset. Must be called before the first sample.
  void set_gyro_offset(const Eigen::Vector3d& offset_rad_s) { rate_.rate.model.nominal.gyro_bias_rad_s = offset_rad_s; }

  /// Buffers a sample that the first pass has processed. No memory is allocated.
  void store_input(const ImuSample& sample);
  void store_input(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points,
                   const std::optional<OdometerReading>& reading, SweepVerdict verdict);

  /// Continues the second pass after each sweep of the first pass. When the second pass has processed all buffered
  /// sweeps, the map of the second pass replaces the map of `first`.
  void replay_next_input(OdometryPass& first);
  /// Runs the second pass to its end. If motion has started but the second pass has not, starts the second pass first.
  void complete_second_pass(OdometryPass& first);
  void abandon_second_pass();

  bool is_applied() const { return is_applied_; }

 private:
  struct Sweep {
    TimeNs start_ns = 0, end_ns = 0;
    std::vector<LidarPoint> points;
    std::optional<OdometerReading> reading;
    SweepVerdict verdict = SweepVerdict::first;
  };

  /// Returns the start of the motion or the start of the sweeps, whichever is later. Parameter `after_motion_s` counts
  /// from the returned time. The motion must have started.
  TimeNs buffer_start_ns() const;
  bool is_due() const;
  bool tracking_failed_in_first_pass() const;
  bool start_second_pass(const OdometryPass& first);
  void run_second_pass(OdometryPass& first, std::size_t sweeps);
  void replace_first_pass_results(OdometryPass& first);
  MotionRegimeStream::Params rate_params_with_delay() const;
  MotionRegimeStream::Params calibrated_rate(const OdometryPass& first) const;
  LidarInertialOdometry::Params calibrated_mapping_params(const OdometryPass& first) const;

  Params params_;
  MotionRegimeStream::Params rate_;
  LidarInertialOdometry::Params mapping_;
  bool enabled_, is_applied_ = false;
  RestDetector rest_detector_;  ///< rest detection with the mapper's parameters
  RestDetector::State stationary_state_;
  std::optional<TimeNs> motion_start_ns_;  ///< end of the initial rest
  OdometryPass::WaitingInputQueue samples_;
  std::deque<Sweep> sweeps_;
  std::optional<OdometryPass> replayed_pass_;
  std::size_t next_sample_ = 0, next_sweep_ = 0;
  std::size_t rejected_in_first_pass_ = 0, rejected_in_second_pass_ = 0;
  bool last_sweep_rejected_ = false;  ///< the second pass rejected its last sweep
  bool started_by_tracking_failure_ = false,
       early_second_pass_tried_ = false;  ///< tracking failure started the current pass; such a pass ended before
};

}  // namespace tumble
