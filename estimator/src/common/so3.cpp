// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/so3.hpp"

#include <cmath>

namespace tumble::so3 {

namespace {
// below this angle the series is exact to rounding
constexpr double kSmallAngle = 1e-4;
}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond exp(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double half_sinc = angle < kSmallAngle ? 0.5 - angle2 / 48.0 : std::sin(0.5 * angle) / angle;
  const double w = angle < kSmallAngle ? 1.0 - angle2 / 8.0 : std::cos(0.5 * angle);
  return {w, half_sinc * phi.x(), half_sinc * phi.y(), half_sinc * phi.z()};
}

Eigen::Vector3d log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double w = sign * q.w();
  const double n = v.norm();
  const double scale = n < kSmallAngle ? 2.0 / w * (1.0 - n * n / (3.0 * w * w)) : 2.0 * std::atan2(n, w) / n;
  return scale * v;
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const bool small = angle < kSmallAngle;
  const double a = small ? 0.5 - angle2 / 24.0 : (1.0 - std::cos(angle)) / angle2;
  const double b = small ? 1.0 / 6.0 - angle2 / 120.0 : (angle - std::sin(angle)) / (angle2 * angle);
  const Eigen::Matrix3d k = hat(phi);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double c = angle < kSmallAngle
                       ? 1.0 / 12.0 + angle2 / 720.0
                       : (1.0 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / angle2;
  const Eigen::Matrix3d k = hat(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * k + c * k * k;
}

Eigen::Quaterniond shortest_arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace tumble::so3
