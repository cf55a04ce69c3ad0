// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Returns the covariance that inertial integration over one sweep adds to the errors of position, attitude and
/// velocity. Angular rate errors are mostly due to saturation, and therefore assumed constant over the sweep. The
/// registration estimates the saturation deficits of the clipped gyro axes in the bit mask `deficit_axes`, so these
/// axes add no noise.
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes);

/// Returns the covariance, in world axes, of the velocity change over a sweep due to accelerometer saturation. The
/// error of a saturated accelerometer axis is assumed constant during the saturation.
Eigen::Matrix3d velocity_variance_from_clipping(const SweepTrajectory& trajectory,
                                                std::span<const MotionSample> samples);

/// Computes the initial state of an IMU at rest, at the origin of the world frame with yaw 0. The mean specific force
/// of the first 0.5 s determines roll and pitch. Returns `degenerate` if the mean specific force is below 1 m/s^2.
Status start_at_rest(std::span<const MotionSample> samples, MotionState& state);
Status level_at_rest(const Eigen::Vector3d& force_I_m_s2, MotionState& state);

/// Returns the standard deviation of the angular rate per axis. For clipped gyro axes without a recovered rate, the
/// standard deviation is increased.
Eigen::Vector3d assumed_rate_sigma(const LidarInertialOdometry::Params& params, const AngularRateState& rate);

/// If two IMU samples are more than kGap_ns apart, the interval is a gap, because one reading does not describe the
/// motion over 50 ms.
inline constexpr TimeNs kGap_ns = 50'000'000;

struct WindowRate {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d sigma_rad_s;
  TimeNs from_ns, time_ns;

  TimeNs middle_ns() const { return from_ns + (time_ns - from_ns) / 2; }
};

/// Fills the gap from the end of `before` to the start of `after` with linearly interpolated angular rates: mapping.md
/// (R44). In a gap, all gyro axes count as clipped, so that the registration also estimates the interpolation error. In
/// a gap of up to 0.64 s, each appended sample covers 10 ms. In a longer gap, each appended sample covers about 1/64 of
/// the gap.
void bridge_gap(const WindowRate& before, const WindowRate& after, std::vector<MotionSample>& samples);

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

/// Bounds of StationaryBounds: at rest, the angular rate differs from the gyro bias by at most `kRate_rad_s`, and the
/// specific force differs from gravity by at most `kForce_m_s2`.
RestDetector::Params mapping_stationary_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
