// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct SweepPoint;

/// Mean specific force and rate over (from_ns, time_ns], in IMU axes.
struct MotionSample {
  TimeNs from_ns = 0;
  TimeNs time_ns = 0;
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_I_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sigma_rad_s = Eigen::Vector3d::Zero();
  std::uint8_t clipped_axes = 0;          ///< bit j: gyro axis j was saturated
  std::uint8_t accel_saturated_axes = 0;  ///< bit j: accelerometer axis j was saturated
  bool at_rest = false;                   ///< within the rest at the start of the run
  std::optional<TimeNs> rest_start_ns;    ///< start of the current rest, detected from the IMU alone
  bool bridges_gap = false;  ///< bridges a gap between IMU samples: unknown specific force, constant velocity
};

/// Motion of the IMU at one time. The covariance refers to position, attitude and velocity in world axes, with the
/// attitude error of AttitudeState.
struct MotionState {
  TimeNs time_ns = 0;
  Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();

  PoseState pose() const;
};

/// Computes the motion of the IMU over a time segment by strapdown integration from a known start.
///
/// The integration is exact if rate and specific force are constant in body axes over each sample, as in a steady spin.
/// SweepTrajectory neglects sculling within a sample and the earth's rotation.
///
/// The saturation deficit (true minus estimated rate) corrects the rate on clipped gyro axes. It is interpolated
/// linearly between kKnots support points, equally spaced over the segment. The equations are in docs/maths/mapping.md.
class SweepTrajectory {
 public:
  static constexpr int kKnots = 3;
  static constexpr int kDeficitUnknowns = 3 * kKnots;
  using Deficit = Eigen::Matrix<double, 3, kKnots>;
  using DeficitJacobian = Eigen::Matrix<double, 3, kDeficitUnknowns>;

  /// Attitude, and double integral of the specific force, at the firing time of a lidar point.
  struct PreintegratedMotion {
    Eigen::Quaterniond q_WI;
    Eigen::Vector3d preintegrated_position_m;
  };
  /// Derivatives of the attitude and of the double integral of the specific force with respect to the saturation
  /// deficit.
  struct SaturationDeficitJacobian {
    DeficitJacobian attitude_by_deficit_s;
    DeficitJacobian position_jacobian_m_s;
  };

  /// Integrates the motion from `start` to `end_ns`. The samples must be contiguous and in time order, beginning at the
  /// start. Returns `insufficient_data` if there is no sample or if the samples end before `end_ns`. Returns
  /// `time_order` if the end is before the start. Returns `gap` with the time in seconds if the first sample begins
  /// after the start.
  Status build(const MotionState& start, std::span<const MotionSample> samples, TimeNs end_ns,
               const Eigen::Vector3d& gravity_W_m_s2, const Deficit& deficit_rad_s = Deficit::Zero());
  /// Same function, with gravity of the magnitude `gravity_m_s2` along -z.
  Status build(const MotionState& start, std::span<const MotionSample> samples, TimeNs end_ns, double gravity_m_s2,
               const Deficit& deficit_rad_s = Deficit::Zero()) {
    return build(start, samples, end_ns, Eigen::Vector3d(0.0, 0.0, -gravity_m_s2), deficit_rad_s);
  }

  TimeNs start_ns() const { return start_.time_ns; }
  double duration_s() const { return duration_s_; }

  /// Largest extrapolation beyond both ends of the segment. The function at() returns the motion at `t_s` seconds after
  /// the start. `hint`, the interval of the previous call, speeds up calls in time order.
  static constexpr double kExtrapolation_s = 0.02;
  PreintegratedMotion at(double t_s, std::size_t& hint) const;
  /// Computes the position of each point in the world minus gravity_free_position_m() at the firing time (lever arm
  /// vector).
  void lever_arm_vectors(std::span<const SweepPoint> points, std::span<Eigen::Vector3f> levers_W_m) const;
  SaturationDeficitJacobian saturation_deficit_jacobian(double t_s, std::size_t& hint) const;
  std::size_t intervals() const { return intervals_.size(); }
  double interval_end_s(std::size_t i) const { return intervals_[i].start_s + intervals_[i].length_s; }

  /// Returns the position at `t_s` that follows from start position, start velocity and gravity, without the specific
  /// force.
  Eigen::Vector3d gravity_free_position_m(double t_s) const {
    return start_.p_WI_m + t_s * start_.v_WI_m_s + (0.5 * t_s * t_s) * gravity_W_m_s2_;
  }

  /// Returns the motion at `t_s` seconds after the start, and the velocity in world axes of a point at `x_I_m` in IMU
  /// axes.
  PreintegratedMotion at(double t_s, const Eigen::Vector3d& x_I_m, std::size_t& hint,
                         Eigen::Vector3d& velocity_m_s) const;

  /// Returns the motion state at `t_s` within the segment. The covariance is propagated without process noise.
  MotionState state(double t_s) const;

  /// Derivatives of position, attitude and velocity with respect to start state, saturation deficit and gravity.
  struct Transition {
    Eigen::Matrix<double, 9, 9> jacobian_start;
    Eigen::Matrix<double, 9, kDeficitUnknowns> jacobian_saturation_deficit_s;
    Eigen::Matrix<double, 9, 3> jacobian_gravity;
  };
  Transition transition(double t_s) const;

  /// Magnitude of the factor on the saturation deficit of each gyro axis in the first interval; 0: axis not clipped.
  Eigen::Vector3d clipped_axes_at_start() const { return intervals_.front().clipped_axis_sign.cwiseAbs(); }
  Eigen::Vector3d clipped_axes_at_end() const { return intervals_.back().clipped_axis_sign.cwiseAbs(); }

  /// Gyro axes that are clipped within the segment; bit j stands for axis j.
  std::uint8_t clipped_axes() const { return clipped_axes_; }

 private:
  struct Interval {
    double start_s, length_s;
    Eigen::Quaterniond q_WI;
    Eigen::Vector3d rate_I_rad_s, specific_force_W_m_s2;
    Eigen::Vector3d preintegrated_velocity_m_s,
        preintegrated_position_m;       // single and double integral of the specific force up to start_s
    Eigen::Vector3d clipped_axis_sign;  // factor on the saturation deficit of each axis; 0: axis not clipped
    Eigen::Matrix<double, kKnots, 1> knot_weight = Eigen::Matrix<double, kKnots, 1>::Zero();
    DeficitJacobian attitude_jacobian, velocity_jacobian, position_jacobian, acceleration_jacobian;
  };
  const Interval& interval_at(double t_s, std::size_t& hint) const;
  static DeficitJacobian saturation_deficit_jacobian_within(const Interval& now, double s);

  MotionState start_;
  double duration_s_ = 0.0;
  Eigen::Vector3d gravity_W_m_s2_ = Eigen::Vector3d::Zero();
  std::uint8_t clipped_axes_ = 0;
  std::vector<Interval> intervals_;
};

}  // namespace tumble
