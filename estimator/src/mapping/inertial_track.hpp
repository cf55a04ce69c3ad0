// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gap_bridge.hpp"
#include "inertial_prior.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"

namespace tumble::mapping {

/// InertialTrack stores the IMU samples since the end of the last sweep, detects rest, and fills gaps between IMU
/// samples.
class InertialTrack {
 public:
  using Params = LidarInertialOdometry::Params;

  explicit InertialTrack(const Params& params);

  /// Returns `ok` if the sample is later than all earlier samples, and `time_order` otherwise.
  Status check(const ImuSample& sample) const;
  /// Requires that check() has accepted the sample.
  void store_sample(const Params& params, const ImuSample& sample, const AngularRateState& rate);

  /// Returns the samples since the last sweep. The last sweep ended within the averaging window of the first returned
  /// sample.
  std::span<const MotionSample> samples() const { return samples_; }
  std::span<const MotionSample> motion_samples_from(TimeNs from_ns) const;
  std::optional<TimeNs> sweep_boundary_ns() const { return sweep_boundary_ns_; }
  /// Returns the mean specific force of the current rest, if the rest lasted at least `lasted_s` up to `time_ns`.
  std::optional<Eigen::Vector3d> resting_force(TimeNs time_ns, double lasted_s) const;
  /// Returns whether the robot was at rest during the first `lasted_s` seconds of the recording. If the recording is
  /// shorter than `lasted_s`, returns whether the robot was at rest during all samples.
  bool starts_at_rest(double lasted_s) const;
  bool has_not_moved() const { return initial_rest_.still_stationary; }
  /// Returns the time of the newest sample, or the end of the last sweep if there are no samples.
  std::optional<TimeNs> last_ns() const;
  bool is_stationary_until(TimeNs end_ns) const;
  bool is_stationary_between(TimeNs from_ns, TimeNs end_ns) const;
  void prune_until(TimeNs end_ns);

 private:
  /// The initial rest ends when the robot first moves, but the gyro bias of the initial rest remains in use.
  struct InitialRest {
    bool still_stationary = true;
    std::optional<TimeNs> first_ns;               ///< first sample of the recording
    std::optional<TimeNs> initial_rest_start_ns;  ///< first sample of the initial rest
    Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  };

  void update_rest(const ImuSample& sample, const AngularRateState& rate, MotionSample& next);
  void revoke_rest(std::optional<TimeNs> rest_start_ns);
  void fill_gap();

  std::vector<MotionSample> samples_;
  std::optional<TimeNs> sweep_boundary_ns_;  // end of the last sweep
  RestDetector rest_detector_;
  RestDetector::State stationary_state_;
  InitialRest initial_rest_;
  std::vector<Eigen::Vector3d> pending_rates_rad_s_;  // rates of samples that the rest detector has not averaged yet
  std::optional<WindowRate> second_newest_rate_, newest_rate_;
};

}  // namespace tumble::mapping
