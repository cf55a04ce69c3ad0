// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/attitude/detail/coarse_alignment.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct TumbleAttitudeState {
  static constexpr int kStates = 10;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector2d v_W_m_s = Eigen::Vector2d::Zero();
  Eigen::Vector2d displacement_W_m = Eigen::Vector2d::Zero();
  /// Covariance of the errors in this order: tilt (phi_x, phi_y) in world axes, gyro bias in IMU axes, velocity,
  /// displacement, heading phi_z. The attitude error phi is defined by q_true = Exp(phi) q_WI.
  Covariance covariance = Covariance::Zero();
  ImuAverage average;  ///< average of the readings that the filter has not yet processed
  Eigen::Matrix3d recovered_covariance_rad2_s2 =
      Eigen::Matrix3d::Zero();  ///< mean covariance of the recovered rates in `average`
  Eigen::Quaterniond last_processed_q_WI = Eigen::Quaterniond::Identity();
  // Integrals since the last measurement update.
  Eigen::Matrix3d integrated_rotation_matrix_s = Eigen::Matrix3d::Zero();
  Eigen::Vector3d force_integral_W_m_s = Eigen::Vector3d::Zero();
  double squared_rate_integral_rad2_s = 0.0;
  Eigen::Vector2d recovered_angle_variance_rad2 =
      Eigen::Vector2d::Zero();  ///< variances of tilt and heading due to recovered rates
  double time_since_node_s = 0.0;
  Eigen::Vector2d recovered_angle_sigma_sum_rad =
      Eigen::Vector2d::Zero();           ///< sum of the standard deviations of recovered rates
  double velocity_variance_m2_s2 = 0.0;  ///< variance of the body's velocity, per axis
  double displacement_variance_m2 = 0.0;
  CoarseAlignment alignment;
  RestDetector::State stationary_state;
  bool at_rest = false;
  // State of a rolling sphere.
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< rate of the last sample, minus the gyro bias
  double slip_duration_s = 0.0, grip_duration_s = 0.0;
  bool slipping = false;
  TimeNs last_time_ns = 0;
  bool started = false;
  bool operator==(const TumbleAttitudeState&) const = default;
};

struct TumbleAttitudeParams {
  static constexpr double kRecoveredTau_s = 0.05;
  /// Random walks of the rate and velocity of tumbling bodies during a gap. On simulated hills, stairs and cliffs, rate
  /// and velocity change by 3.0 to 11.4 rad/s and 2.4 to 4.1 m/s per sqrt(s) (docs/figures.md).
  static constexpr double kGapRateWalk_rad_s_sqrts = 7.0;
  static constexpr double kGapVelocityWalk_m_s_sqrts = 3.3;
  double gravity_m_s2 = 9.80665;
  double radius_m = 0.0;  ///< radius of a sphere that rolls on a level floor; 0: not a sphere
  Eigen::Vector3d lever_arm_m =
      Eigen::Vector3d::Zero();  ///< lever arm from the body's centre to the IMU, in sensor axes

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.radius_m, {"radius_m", "m", 0.0, 10.0, "radius of the sphere"});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
  }
};

/// Estimates attitude from gyro and accelerometer, for a body whose velocity is bounded, and zero at rest.
///
/// TumbleAttitude integrates gyro and accelerometer. Every 0.04 s, weak pseudo-measurements of zero velocity and zero
/// displacement correct tilt and gyro bias. At rest, TumbleAttitude measures the gyro bias and keeps the attitude
/// constant. The equations are in docs/maths/attitude.md.
///
/// If the tilt variance cannot explain a large velocity or displacement, the motion is real. TumbleAttitude then
/// increases the assumed standard deviation of velocity or displacement for 3 s.
///
/// For a rolling sphere, the rolling constraint predicts the velocity of the IMU from the rate, and so the integral of
/// the specific force. This prediction replaces the pseudo-measurements. A velocity that does not fit the rolling
/// constraint indicates slip. During slip, TumbleAttitude pauses the corrections for at most 3 s.
///
/// In a gap between samples longer than 0.05 s, TumbleAttitude interpolates the rate and keeps the velocity, with
/// increased variances. A body that is at rest before and after a gap is assumed to be at rest during the gap. If a gap
/// increases the tilt's standard deviation to 0.3 rad, the linearisation of the Kalman filter may be invalid. A coarse
/// alignment (CoarseAlignment) then estimates the tilt in parallel to the Kalman filter. Until the coarse alignment
/// ends, the reported tilt variance is at least the variance after the gap. If Kalman filter and coarse alignment
/// disagree, the filter restarts from the alignment.
///
/// The attitude is wrong if the body accelerates in one direction for many seconds. The heading drifts, because
/// TumbleAttitude has no heading reference. Bias and scale errors of the accelerometer cause a tilt error.
class TumbleAttitude {
 public:
  using Params = TumbleAttitudeParams;
  using State = TumbleAttitudeState;

  explicit TumbleAttitude(const Params& params);

  /// Processes one sample. The specific force of the first sample determines the initial tilt; the initial yaw is 0. On
  /// error, the state is unchanged. Cost: O(1), no allocation.
  Status step(const ImuSample& sample, State& state) const { return step(sample, Eigen::Matrix3d::Zero(), state); }
  /// Processes a sample whose rate was recovered from saturation. `rate_covariance_rad2_s2` is the covariance of the
  /// rate in sensor axes, or zero for a measured rate. The error of a recovered rate has the correlation time
  /// `kRecoveredTau_s`. Returns `out_of_range` if the covariance is not finite or has a negative variance.
  Status step(const ImuSample& sample, const Eigen::Matrix3d& rate_covariance_rad2_s2, State& state) const;

  /// Returns the covariance of the attitude error at the last correction, with the error as defined in AttitudeState.
  static Eigen::Matrix3d attitude_covariance_rad2(const State& state);

 private:
  void start(State& state) const;
  void process_averaged_reading(State& state) const;
  bool rotates_within_gyro_bias(const State& state) const;
  void integrate(const ImuSample& sample, double dt_s, State& state) const;
  void bridge_gap(const ImuSample& after, const Eigen::Matrix3d& rate_covariance_rad2_s2, double gap_s,
                  State& state) const;
  void add_recovered_rate_variance(double dt_s, State& state) const;
  void end_node(State& state) const;
  void predict_node(State& state) const;
  void correct_with_mean_force(State& state) const;
  void align(const Eigen::Quaterniond& corrected, State& state) const;
  void restart(const Eigen::Quaterniond& levelling, double tilt_rad2, double velocity_m2_s2, State& state) const;
  double body_velocity_variance_m2_s2(double power_m2_s2, const State& state) const;
  Eigen::Vector2d velocity_from_rotation(const State& state) const;
  void correct_body_motion(const Eigen::Vector2d& turned_m_s, State& state) const;
  double body_motion_variance(const Eigen::Vector2d& misfit, int index, double sigma_sqrts, double power,
                              const State& state) const;
  bool detect_slip(const Eigen::Vector2d& misfit_m_s, State& state) const;

  Params params_;
  RestDetector rest_detector_;
};

}  // namespace tumble
