// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

struct SweepPoint;

/// MotionSample is one IMU sample with its estimated angular velocity. The force and rate of a MotionSample are means
/// over (from_ns, time_ns].
struct MotionSample {
  TimeNs from_ns = 0;
  TimeNs time_ns = 0;
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_I_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sigma_rad_s = Eigen::Vector3d::Zero();  ///< standard deviation of the rate, IMU axes
  std::uint8_t clipped_axes = 0;                               ///< bit j: gyro axis j was saturated
  std::uint8_t accel_saturated_axes = 0;                       ///< bit j: accelerometer axis j was saturated
  bool at_rest = false;                 ///< the sample belongs to the rest at the start of the run
  std::optional<TimeNs> rest_start_ns;  ///< first sample of the current rest, from the IMU alone
  bool in_flight = false;               ///< f_I_m_s2 is the computed force of free flight, not a measurement
  bool bridges_gap = false;             ///< the sample bridges a gap: the force is unknown, the velocity constant
};

/// MotionState contains the motion of the IMU at one time, with the errors of position, attitude and velocity in world
/// axes. The attitude error is defined as in AttitudeState.
struct MotionState {
  TimeNs time_ns = 0;
  Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();

  PoseState pose() const;
};

/// Computes the motion of the IMU over a segment by strapdown integration from a known start. SweepTrajectory can
/// evaluate the motion at any time of the segment.
///
/// The attitude is R(t) = R_k Exp(w_k (t - t_k)) with the rate w_k of sample k. The attitude is exact if the rate is
/// constant in body axes over each sample. The position is p(t) = p_0 + v_0 t + g t^2 / 2 + S(t). The vectors p_0 and
/// v_0 are position and velocity at the start, g is gravity, and S is the double integral of the specific force. The
/// mean force over a sample of length dt is R_k J_l(w_k dt) f_k, with attitude R_k, rate w_k, measured force f_k and
/// left Jacobian J_l. The mean force is exact if the force is constant in body axes, like the centripetal force of a
/// spin.
///
/// The saturation deficit e is the true rate minus the clipped reading, and corrects the clipped axes. The saturation
/// deficit is linear in time between kKnots knots, at equal steps from the start to the end of the segment. If axis j
/// is clipped, the corrected rate is w_j + s_j e_j(t), with the measured rate w_j, a factor s_j and the saturation
/// deficit e_j. The factor s_j has the sign of the rate w_j. The magnitude of s_j is the rate's standard deviation
/// sigma_j, divided by the largest sigma_j of the segment's clipped samples. The saturation deficit corrects rates with
/// a small standard deviation only a little. The magnitude of s_j is 1 if all standard deviations sigma_j are 0. Within
/// a sample, the saturation deficit is constant and has the value at the middle of the sample. SweepTrajectory neglects
/// sculling within a sample and the earth's rotation.
class SweepTrajectory {
 public:
  static constexpr int kKnots = 3;
  static constexpr int kDeficitSize = 3 * kKnots;  ///< number of unknowns, axis by axis within a knot
  using Deficit = Eigen::Matrix<double, 3, kKnots>;
  using DeficitJacobian = Eigen::Matrix<double, 3, kDeficitSize>;

  /// PreintegratedMotion is the attitude R(t) and the double integral S(t) of the specific force at the time of a lidar
  /// point.
  struct PreintegratedMotion {
    Eigen::Quaterniond q_WI;
    Eigen::Vector3d preintegrated_position_m;
  };
  /// DeficitDerivative contains the first-order derivatives of the attitude and of S(t) by the saturation deficit e.
  /// The attitude error is attitude_jacobian_s * e, and the error of S is position_jacobian_m_s * e.
  struct DeficitDerivative {
    DeficitJacobian attitude_jacobian_s;
    DeficitJacobian position_jacobian_m_s;
  };

  /// Integrates the motion from `start` to `end_ns`. The samples must be contiguous and in time order, beginning at the
  /// start. Returns `too_few` if there is no sample or if the samples end before `end_ns`. Returns `time_order` if the
  /// end is before the start. Returns `gap` with the time in seconds if the first sample begins after the start.
  /// Repeated calls of build() reuse the memory of the trajectory.
  Status build(const MotionState& start, std::span<const MotionSample> samples, TimeNs end_ns,
               const Eigen::Vector3d& gravity_W_m_s2, const Deficit& deficit_rad_s = Deficit::Zero());
  /// Integrates the motion from `start` to `end_ns`, with gravity of magnitude `gravity_m_s2` along -z.
  Status build(const MotionState& start, std::span<const MotionSample> samples, TimeNs end_ns, double gravity_m_s2,
               const Deficit& deficit_rad_s = Deficit::Zero()) {
    return build(start, samples, end_ns, Eigen::Vector3d(0.0, 0.0, -gravity_m_s2), deficit_rad_s);
  }

  TimeNs start_ns() const { return start_.time_ns; }
  double duration_s() const { return duration_s_; }

  /// Returns the motion at `t_s` seconds after the start. Outside of the segment, at() extrapolates the motion by up to
  /// kExtrapolation_s, which covers errors of the time offset. The argument `hint` is the interval of the previous
  /// call, and speeds up calls in time order. Any value of `hint` in [0, intervals()) is valid.
  static constexpr double kExtrapolation_s = 0.02;
  PreintegratedMotion at(double t_s, std::size_t& hint) const;
  /// Computes the lever arm vector S(t) + R(t) x of each point x. The function is faster than at() for several points,
  /// and gives bit-identical results.
  void lever_arm_vectors(std::span<const SweepPoint> points, std::span<Eigen::Vector3f> levers_W_m) const;
  DeficitDerivative deficit_derivative(double t_s, std::size_t& hint) const;
  std::size_t intervals() const { return intervals_.size(); }
  /// Returns the end of interval i in seconds after the start of the segment.
  double interval_end_s(std::size_t i) const { return intervals_[i].start_s + intervals_[i].length_s; }

  /// Returns the common part p_0 + v_0 t + g t^2 / 2 of the positions of all points at time t. The position of a point
  /// x is common_position_m(t) plus the lever arm vector u(t) = S(t) + R(t) x.
  Eigen::Vector3d common_position_m(double t_s) const {
    return start_.p_WI_m + t_s * start_.v_WI_m_s + (0.5 * t_s * t_s) * gravity_W_m_s2_;
  }

  /// Returns the motion at `t_s` seconds after the start, and the velocity in world axes of a point at x_I in IMU axes.
  PreintegratedMotion at(double t_s, const Eigen::Vector3d& x_I_m, std::size_t& hint,
                         Eigen::Vector3d& velocity_m_s) const;

  /// Returns the full motion state at the time `t_s` within the segment. The covariance is propagated without process
  /// noise.
  MotionState state(double t_s) const;

  /// Transition contains the first-order derivatives of the state at time t_s (position, attitude, velocity) with
  /// respect to the start state, the saturation deficit and gravity.
  struct Transition {
    Eigen::Matrix<double, 9, 9> jacobian_start;
    Eigen::Matrix<double, 9, kDeficitSize> jacobian_deficit_s;
    Eigen::Matrix<double, 9, 3> jacobian_gravity;
  };
  Transition transition(double t_s) const;

  /// Return the magnitude |s_j| of the saturation deficit's factor in the first and in the last interval. The magnitude
  /// |s_j| is 0 if axis j is not clipped in the interval.
  Eigen::Vector3d deficit_factor_at_start() const { return intervals_.front().deficit_factor.cwiseAbs(); }
  Eigen::Vector3d deficit_factor_at_end() const { return intervals_.back().deficit_factor.cwiseAbs(); }

  /// Returns the gyro axes that were clipped anywhere in the segment: bit j for axis j.
  std::uint8_t clipped_axes() const { return clipped_axes_; }

 private:
  struct Interval {
    double start_s, length_s;
    Eigen::Quaterniond q_WI;
    Eigen::Vector3d rate_I_rad_s, specific_force_W_m_s2;  // rate in body axes; mean specific force in W
    Eigen::Vector3d preintegrated_velocity_m_s,
        preintegrated_position_m;    // integrals of the specific force up to start_s
    Eigen::Vector3d deficit_factor;  // factor s_j where axis j is clipped, 0 elsewhere
    Eigen::Matrix<double, kKnots, 1> knot_weight =
        Eigen::Matrix<double, kKnots, 1>::Zero();  // weight of each knot's deficit in the interval
    DeficitJacobian attitude_jacobian, velocity_jacobian, position_jacobian,
        acceleration_jacobian;  // derivatives at start_s
  };
  const Interval& interval_at(double t_s, std::size_t& hint) const;
  static DeficitJacobian deficit_jacobian_within(const Interval& now, double s);

  MotionState start_;
  double duration_s_ = 0.0;
  Eigen::Vector3d gravity_W_m_s2_ = Eigen::Vector3d::Zero();
  std::uint8_t clipped_axes_ = 0;
  std::vector<Interval> intervals_;
};

}  // namespace tumble
