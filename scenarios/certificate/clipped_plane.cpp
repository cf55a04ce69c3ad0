// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/clipped_plane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::scenarios {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep_s = 0.0005;

Matrix3d matrix(const std::vector<Vector3d>& rows) {
  Matrix3d out = Matrix3d::Identity();
  for (std::size_t i = 0; i < rows.size() && i < 3; ++i) out.row(static_cast<Eigen::Index>(i)) = rows[i];
  return out;
}

int side(const SensedTriad& triad, std::size_t k, int j) {
  constexpr double kMargin = 0.08;
  int sign = 0;
  for (std::size_t i = k - 1; i <= k + 1; ++i) {
    const Vector3d sensed = (triad.axes * triad.unclipped[i] + triad.offset) / triad.rail;
    for (int element = 0; element < 3; ++element) {
      if (element != j && std::abs(sensed[element]) > 1.0 - kMargin) return 0;
    }
    if (std::abs(sensed[j]) < 1.0 + kMargin) return 0;
    sign = sensed[j] > 0.0 ? 1 : -1;
  }
  return sign;
}

}  // namespace

sim::Truth beyond_every_rail(double gyro_rail_rad_s, double accel_rail_m_s2) {
  constexpr double kEach_s = 2.0;
  sim::Truth truth;
  truth.period_ns = std::llround(kStep_s * 1e9);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k <= std::lround(3.0 * kEach_s / kStep_s); ++k) {
    const double t = k * kStep_s;
    Vector3d rate(std::sin(11.0 * t), std::sin(14.0 * t + 1.0), std::sin(8.0 * t + 2.0));
    for (int axis = 0; axis < 3; ++axis) {
      rate[axis] *= (axis == static_cast<int>(t / kEach_s) ? 1.6 : 0.5) * gyro_rail_rad_s;
    }
    truth.q_WB.push_back(q);
    truth.w_WB_B_rad_s.push_back(rate);
    truth.v_WB_m_s.emplace_back(1.5 * accel_rail_m_s2 * t, 0.0, 0.0);
    truth.p_WB_m.emplace_back(Vector3d::Zero());
    q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(rate.norm() * kStep_s, rate.normalized()))).normalized();
  }
  return truth;
}

SensedTriad sensed_rates(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_rad_s) {
  return {record.gyro_rad_s, truth.gyro_unclipped_rad_s, matrix(truth.gyro_elements), truth.gyro_element_offset_rad_s,
          rail_rad_s};
}

SensedTriad sensed_forces(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_m_s2) {
  return {record.accel_m_s2, truth.accel_unclipped_m_s2, matrix(truth.accel_elements), truth.accel_element_offset_m_s2,
          rail_m_s2};
}

ClippedPlane plane_of(const Matrix3d& axes, const Vector3d& offset, double rail, int j) {
  const double own = axes(j, j);
  return {-axes(j, (j + 1) % 3) / own, -axes(j, (j + 2) % 3) / own, rail / own, -offset[j] / own};
}

ClippedPlane fit_clipped_plane(const SensedTriad& triad, int j, int& samples) {
  const int first = (j + 1) % 3, second = (j + 2) % 3;
  std::vector<std::size_t> clipped;
  std::array<int, 2> count = {0, 0};
  for (std::size_t k = 1; k + 1 < triad.readings.size(); ++k) {
    const int sign = side(triad, k, j);
    if (sign == 0) continue;
    clipped.push_back(k);
    ++count[sign > 0 ? 0 : 1];
  }
  samples = std::min(count[0], count[1]);
  if (samples < kFewestClipped) return {std::nan(""), std::nan(""), std::nan(""), std::nan("")};
  Eigen::MatrixX4d known(clipped.size(), 4);
  Eigen::VectorXd read(clipped.size());
  for (std::size_t i = 0; i < clipped.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3d& y = triad.readings[clipped[i]];
    known.row(row) << y[first], y[second], side(triad, clipped[i], j), 1.0;
    read[row] = y[j];
  }
  const Eigen::Vector4d fitted = known.colPivHouseholderQr().solve(read);
  return {fitted[0], fitted[1], fitted[2], fitted[3]};
}

}  // namespace tumble::scenarios
