// SPDX-License-Identifier: BSD-3-Clause
#include "oracles/torque_free_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "oracles/jacobi_elliptic.hpp"

namespace tumble::oracles {

namespace {

// Gauss-Legendre of order 8 on [-1, 1]
constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                          0.9602898564975363};
constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                            0.1012285362903763};
// panels per half period; the integrand is smooth, and twice as many panels change the result by less than 1e-14
constexpr int kPanels = 64;

void check_moments(const Eigen::Vector3d& moments) {
  const double largest = moments.maxCoeff();
  if (!moments.allFinite() || moments.minCoeff() <= 0.0 || 2.0 * largest > moments.sum() * (1.0 + 1e-12)) {
    throw std::invalid_argument("principal moments must be positive, none above the sum of the others");
  }
}

}  // namespace

TorqueFreeRotation::TorqueFreeRotation(const Eigen::Vector3d& moments, const Eigen::Vector3d& w_WB_B_rad_s,
                                       const Eigen::Quaterniond& q_WB)
    : moments_(moments), rate0_(w_WB_B_rad_s), q_WB0_(q_WB.normalized()) {
  check_moments(moments);
  if (!w_WB_B_rad_s.allFinite()) throw std::invalid_argument("the rate must be finite");
  const Eigen::Vector3d L = moments.cwiseProduct(rate0_);
  momentum_ = L.norm();
  steady_ = rate0_.cross(L).norm() <= 1e-14 * rate0_.norm() * momentum_;
  if (steady_) return;

  // roles: dn on the axis (of largest or smallest moment) that the rate circles, sn on the middle axis
  std::sort(axes_, axes_ + 3, [&](int i, int j) { return moments[i] < moments[j]; });
  const double twice_energy = rate0_.dot(L);
  const double L2 = momentum_ * momentum_;
  if (L2 < twice_energy * moments[axes_[1]]) std::swap(axes_[0], axes_[2]);
  const double I1 = moments[axes_[0]], I2 = moments[axes_[1]], I3 = moments[axes_[2]];
  const double w1 = rate0_[axes_[0]], w2 = rate0_[axes_[1]], w3 = rate0_[axes_[2]];
  // wobble is 2 E I3 - L^2 and spin is L^2 - 2 E I1; both are written as sums of positive terms, so that no terms
  // cancel
  const double wobble = I1 * (I3 - I1) * w1 * w1 + I2 * (I3 - I2) * w2 * w2;
  const double spin = I2 * (I2 - I1) * w2 * w2 + I3 * (I3 - I1) * w3 * w3;
  const double k2 = (I2 - I1) * wobble / ((I3 - I2) * spin);
  if (!(k2 <= 1.0 - 1e-9)) throw std::invalid_argument("rotation on the separatrix has no period");

  modulus_ = std::sqrt(std::max(0.0, k2));
  frequency_rad_s_ = std::sqrt((I3 - I2) * spin / (I1 * I2 * I3));
  const double sign3 = w3 < 0.0 ? -1.0 : 1.0;
  // Euler's equations change sign when the roles are assigned to the axes in a left-handed order
  const bool right_handed = (axes_[0] + 1) % 3 == axes_[1];
  const double sign2 = (I3 > I2) == right_handed ? sign3 : -sign3;
  amplitude_ = {std::sqrt(wobble / (I1 * (I3 - I1))), sign2 * std::sqrt(wobble / (I2 * (I3 - I2))),
                sign3 * std::sqrt(spin / (I3 * (I3 - I1)))};
  argument0_ = std::ellint_1(modulus_, std::atan2(w2 / amplitude_[1], w1 / amplitude_[0]));
  half_period_s_ = 2.0 * complete_elliptic_first(modulus_) / frequency_rad_s_;
  half_period_angle_rad_ = integrate_precession(half_period_s_);
}

double TorqueFreeRotation::period_s() const {
  return steady_ ? std::numeric_limits<double>::infinity() : 2.0 * half_period_s_;
}

Eigen::Vector3d TorqueFreeRotation::rate(double t_s) const {
  if (steady_) return rate0_;
  const JacobiElliptic j = jacobi_elliptic(frequency_rad_s_ * t_s + argument0_, modulus_);
  Eigen::Vector3d w;
  w[axes_[0]] = amplitude_[0] * j.cn;
  w[axes_[1]] = amplitude_[1] * j.sn;
  w[axes_[2]] = amplitude_[2] * j.dn;
  return w;
}

Eigen::Vector3d TorqueFreeRotation::acceleration(double t_s) const {
  const Eigen::Vector3d w = rate(t_s);
  return moments_.cwiseProduct(w).cross(w).cwiseQuotient(moments_);
}

Eigen::Vector3d TorqueFreeRotation::specific_force(double t_s, const Eigen::Vector3d& p_BI_m) const {
  const Eigen::Vector3d w = rate(t_s);
  return acceleration(t_s).cross(p_BI_m) + w.cross(w.cross(p_BI_m));
}

Eigen::Vector3d TorqueFreeRotation::momentum_direction(double t_s) const {
  return moments_.cwiseProduct(rate(t_s)).normalized();
}

// The matrix has three columns in B: the direction l of the angular momentum, m = d x l normalised (d is the axis of
// dn), and l x m. In the world, l is fixed and m turns about l.
Eigen::Matrix3d TorqueFreeRotation::momentum_frame_in_body(double t_s) const {
  const Eigen::Vector3d l = momentum_direction(t_s);
  const Eigen::Vector3d m = Eigen::Vector3d::Unit(axes_[2]).cross(l).normalized();
  Eigen::Matrix3d frame;
  frame << l, m, l.cross(m);
  return frame;
}

// the function returns the rate at which m turns about l: L (I1 w1^2 + I2 w2^2) / (I1^2 w1^2 + I2^2 w2^2), with the
// axes numbered by role
double TorqueFreeRotation::precession_rate(double t_s) const {
  const Eigen::Vector3d w = rate(t_s);
  const double l1 = moments_[axes_[0]] * w[axes_[0]], l2 = moments_[axes_[1]] * w[axes_[1]];
  return momentum_ * (l1 * w[axes_[0]] + l2 * w[axes_[1]]) / (l1 * l1 + l2 * l2);
}

double TorqueFreeRotation::integrate_precession(double t_s) const {
  const int panels = 1 + static_cast<int>(kPanels * std::abs(t_s) / half_period_s_);
  const double half = 0.5 * t_s / panels;
  double sum = 0.0;
  for (int p = 0; p < panels; ++p) {
    const double middle = (2 * p + 1) * half;
    for (std::size_t i = 0; i < kNodes.size(); ++i) {
      sum += kWeights[i] * (precession_rate(middle - kNodes[i] * half) + precession_rate(middle + kNodes[i] * half));
    }
  }
  return sum * half;
}

double TorqueFreeRotation::precession_angle(double t_s) const {
  const double whole = std::floor(t_s / half_period_s_);
  return whole * half_period_angle_rad_ + integrate_precession(t_s - whole * half_period_s_);
}

Eigen::Quaterniond TorqueFreeRotation::attitude(double t_s) const {
  if (steady_) {
    const double speed = rate0_.norm();
    if (speed == 0.0) return q_WB0_;
    return q_WB0_ * Eigen::Quaterniond(Eigen::AngleAxisd(speed * t_s, rate0_ / speed));
  }
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(precession_angle(t_s), Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d R_B0B = momentum_frame_in_body(0.0) * turn * momentum_frame_in_body(t_s).transpose();
  return (q_WB0_ * Eigen::Quaterniond(R_B0B)).normalized();
}

}  // namespace tumble::oracles
