// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tumble/rolling/rolling_filter.hpp"

namespace tumble {

/// First index of each part of RollingFilter's error state.
inline constexpr int kAttitude = 0, kVelocity = 3, kPosition = 6, kGyroBias = 9, kAccelBias = 12, kAccelScale = 15,
                     kGyroScale = 24, kDelay = 33, kLeverArm = 34;

inline double squared(double x) {
  return x * x;
}

/// Kalman update of one hypothesis by a scalar row: measurement = row x + noise.
inline void update(const Eigen::Matrix<double, 1, RollingFilter::kStates>& row, double measured, double variance,
                   RollingFilter::Hypothesis& h) {
  const RollingFilter::Vector PHt = h.P * row.transpose();
  const double s = row.dot(PHt) + variance;
  h.x += PHt * ((measured - row.dot(h.x)) / s);
  h.P -= PHt * (PHt / s).transpose();
}

/// The same for a row that picks one state.
inline void update(int index, double measured, double variance, RollingFilter::Hypothesis& h) {
  const RollingFilter::Vector column = h.P.col(index);
  const double s = column[index] + variance;
  h.x += column * ((measured - h.x[index]) / s);
  h.P -= column * (column / s).transpose();
}

/// What the other hypotheses add to the position's covariance about the best one: sum of w d d^T over the sum of w.
inline Eigen::Matrix3d position_spread(const RollingFilter::State& state) {
  const Eigen::Vector3d best = state.hypotheses[0].x.segment<3>(kPosition);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double total = 0.0;
  for (int k = 0; k < state.count; ++k) {
    const RollingFilter::Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    const double weight = std::exp(h.log_weight - state.hypotheses[0].log_weight);
    const Eigen::Vector3d d = h.x.segment<3>(kPosition) - best;
    spread += weight * d * d.transpose();
    total += weight;
  }
  return spread / total;
}

}  // namespace tumble
