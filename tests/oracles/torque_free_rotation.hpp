// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tumble::oracles {

/// Closed-form rotation of a rigid body without torque.
///
/// Body axes B are principal axes. The rate is given by Jacobi elliptic functions (Landau & Lifshitz, Mechanics,
/// section 37). The constant angular momentum determines two angles of the attitude. The third angle, about the angular
/// momentum, is an elliptic integral of the third kind. This angle is computed by Gauss-Legendre quadrature of the
/// closed-form rate (converged to rounding); whole half-periods are counted and integrated only once.
///
/// Accepts principal moments in any order, also equal moments. Throws std::invalid_argument for impossible moments, and
/// for the separatrix, where the period is infinite (1 - k^2 < 1e-9), unless the spin is constant.
class TorqueFreeRotation {
 public:
  /// Principal moments [kg m^2, any common scale], rate w_WB in B at t = 0 [rad/s], attitude q_WB at t = 0.
  TorqueFreeRotation(const Eigen::Vector3d& moments, const Eigen::Vector3d& w_WB_B_rad_s,
                     const Eigen::Quaterniond& q_WB = Eigen::Quaterniond::Identity());

  /// w_WB in B at time t [rad/s]; t may be negative.
  Eigen::Vector3d rate(double t_s) const;
  /// Time derivative of the rate in B [rad/s^2], by Euler's equation.
  Eigen::Vector3d acceleration(double t_s) const;
  /// Attitude at time t, body to world.
  Eigen::Quaterniond attitude(double t_s) const;
  /// Returns the reading of an ideal accelerometer at p_BI (from the centre of mass, in B) in free flight, in B: f =
  /// alpha x p + w x (w x p) [m/s^2].
  Eigen::Vector3d specific_force(double t_s, const Eigen::Vector3d& p_BI_m) const;

  /// Returns the time after which the rate repeats [s]; infinite for a constant spin.
  double period_s() const;
  bool steady() const { return steady_; }

 private:
  Eigen::Vector3d momentum_direction(double t_s) const;
  Eigen::Matrix3d momentum_frame_in_body(double t_s) const;
  double precession_rate(double t_s) const;
  double precession_angle(double t_s) const;
  double integrate_precession(double t_s) const;

  Eigen::Vector3d moments_;
  Eigen::Vector3d rate0_;
  Eigen::Quaterniond q_WB0_;
  bool steady_ = false;
  // axes_[0], axes_[1], axes_[2] are the body axes of cn, sn and dn
  int axes_[3] = {0, 1, 2};
  Eigen::Vector3d amplitude_ = Eigen::Vector3d::Zero();  // signed, by role
  double momentum_ = 0.0;
  double frequency_rad_s_ = 0.0;  // d(argument)/dt of the elliptic functions
  double modulus_ = 0.0;
  double argument0_ = 0.0;
  double half_period_s_ = 0.0;
  double half_period_angle_rad_ = 0.0;
};

}  // namespace tumble::oracles
