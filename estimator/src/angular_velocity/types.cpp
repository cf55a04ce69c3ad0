// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "../common/dense.hpp"

namespace tumble {

namespace {

std::array<Eigen::Matrix3d, 5> make_inertia_basis() {
  std::array<Eigen::Matrix3d, 5> basis;
  for (auto& s : basis) s.setZero();
  const double half = std::sqrt(0.5), sixth = std::sqrt(1.0 / 6.0);
  basis[0].diagonal() << half, -half, 0.0;
  basis[1].diagonal() << sixth, sixth, -2.0 * sixth;
  basis[2](0, 1) = basis[2](1, 0) = half;
  basis[3](0, 2) = basis[3](2, 0) = half;
  basis[4](1, 2) = basis[4](2, 1) = half;
  return basis;
}

}  // namespace

const Eigen::Matrix3d& BodyImuConstants::inertia_basis_matrix(int i) {
  static const std::array<Eigen::Matrix3d, 5> kBasis = make_inertia_basis();
  return kBasis[static_cast<std::size_t>(i)];
}

// See rate_smoother.md (R3).
Eigen::Matrix3d BodyImuConstants::inertia_matrix_with_trace_3() const {
  const double half = 0.5 * std::numbers::sqrt2, sixth = std::numbers::inv_sqrt3 * half;
  const double a = half * inertia_coordinates[0], b = sixth * inertia_coordinates[1];
  const double xy = half * inertia_coordinates[2], xz = half * inertia_coordinates[3],
               yz = half * inertia_coordinates[4];
  Eigen::Matrix3d J;
  J << 1.0 + a + b, xy, xz, xy, 1.0 - a + b, yz, xz, yz, 1.0 - 2.0 * b;
  return J;
}

Eigen::Matrix<double, 5, 1> BodyImuConstants::inertia_basis_coordinates(const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d J = 3.0 / inertia.trace() * inertia;
  Eigen::Matrix<double, 5, 1> coordinates;
  for (int i = 0; i < 5; ++i) coordinates[i] = J.cwiseProduct(inertia_basis_matrix(i)).sum();
  return coordinates;
}

Eigen::Vector3d BodyImuConstants::gyro_sensing_direction(int element) const {
  Eigen::Vector3d row;
  row[element] = 1.0;
  row[(element + 1) % 3] = gyro_misalignment[2 * element];
  row[(element + 2) % 3] = gyro_misalignment[2 * element + 1];
  return row;
}

// See rate_smoother.md (R2).
BodyImuConstants::Vector BodyImuConstants::vector() const {
  Vector v;
  v << lever_arm_m, gyro_bias_rad_s, accel_bias_m_s2, inertia_coordinates, gyro_misalignment;
  return v;
}

void BodyImuConstants::add(const Vector& increment) {
  lever_arm_m += increment.segment<3>(0);
  gyro_bias_rad_s += increment.segment<3>(3);
  accel_bias_m_s2 += increment.segment<3>(6);
  inertia_coordinates += increment.segment<5>(9);
  gyro_misalignment += increment.segment<6>(kGyroMisalignmentIndex);
}

Status check_body_imu_constants(const BodyImuConstants& constants) {
  constexpr double kMaxConstantMagnitude = BodyImuConstants::kMaxConstantMagnitude;
  const auto beyond = [](double value) { return !(std::abs(value) <= kMaxConstantMagnitude); };
  const BodyImuConstants::Vector all = constants.vector();
  const auto first = std::find_if(all.begin(), all.end(), beyond);
  if (first == all.end()) return {};
  const char* const name = first - all.begin() < constants.lever_arm_m.size() ? "lever_arm_m" : "rig constants";
  return {ErrorCode::out_of_range, name, *first, std::copysign(kMaxConstantMagnitude, *first)};
}

Status check_body_imu_calibration(const BodyImuCalibration& calibration) {
  if (const Status status = check_body_imu_constants(calibration.constants); !status.ok()) return status;
  const BodyImuConstants::Matrix& P = calibration.covariance;
  const BodyImuConstants::Matrix symmetric = 0.5 * (P + P.transpose());
  if (symmetric.allFinite() && dense::Cholesky(symmetric).ok()) return {};
  return {ErrorCode::degenerate, "calibration covariance", symmetric.trace(), 0.0};
}

const char* to_string(AngularRateSource source) {
  switch (source) {
    case AngularRateSource::measured:
      return "measured";
    case AngularRateSource::recovered_in_flight:
      return "recovered_in_flight";
    case AngularRateSource::recovered_in_contact:
      return "recovered_in_contact";
    case AngularRateSource::lower_bound_only:
      return "lower_bound_only";
  }
  return "unknown";
}

}  // namespace tumble
