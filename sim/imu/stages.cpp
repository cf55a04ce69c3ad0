// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/stages.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::sim {

Eigen::Vector3d normals(Stream& stream, double sigma) {
  if (sigma == 0.0) return Eigen::Vector3d::Zero();
  const double x = stream.normal(), y = stream.normal(), z = stream.normal();
  return sigma * Eigen::Vector3d(x, y, z);
}

double bounded_normal(Stream& stream, double sigma) {
  return sigma > 0.0 ? sigma * std::clamp(stream.normal(), -3.0, 3.0) : 0.0;
}

DelayLine::DelayLine(double delay_s, double rate_hz) {
  const double samples = delay_s * rate_hz;
  if (!(samples > 0.0)) return;
  const double whole = std::floor(samples);
  fraction_ = samples - whole;
  past_.resize(static_cast<std::size_t>(whole) + 2);
}

Eigen::Vector3d DelayLine::operator()(const Eigen::Vector3d& input) {
  if (past_.empty()) return input;
  if (!started_) std::fill(past_.begin(), past_.end(), input);
  started_ = true;
  past_[next_] = input;
  next_ = (next_ + 1) % past_.size();
  const Eigen::Vector3d &oldest = past_[next_], &newer = past_[(next_ + 1) % past_.size()];
  return fraction_ * oldest + (1.0 - fraction_) * newer;
}

LowPass::LowPass(double cutoff_hz, double rate_hz) : on_(cutoff_hz > 0.0) {
  if (!on_) return;
  const double k = std::tan(std::numbers::pi * cutoff_hz / rate_hz);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
  b0_ = k * k * norm;
  b1_ = 2.0 * b0_;
  b2_ = b0_;
  a1_ = 2.0 * (k * k - 1.0) * norm;
  a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
}

Eigen::Vector3d LowPass::operator()(const Eigen::Vector3d& input) {
  if (!on_) return input;
  if (!started_) {  // steady state for this input
    s1_ = (1.0 - b0_) * input;
    s2_ = (b2_ - a2_) * input;
    started_ = true;
  }
  const Eigen::Vector3d output = b0_ * input + s1_;
  s1_ = b1_ * input - a1_ * output + s2_;
  s2_ = b2_ * input - a2_ * output;
  return output;
}

Eigen::Matrix3d draw_axis_errors(Stream& stream, double scale_sigma, double misalignment_sigma_rad) {
  Eigen::Matrix3d errors = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      errors(row, column) += (row == column ? scale_sigma : misalignment_sigma_rad) * stream.normal();
    }
  }
  return errors;
}

void RangeChoice::update(const Eigen::Vector3d& signal) {
  if (handover_ <= 0.0) return;
  for (int axis = 0; axis < 3; ++axis) {
    bool& precise = precise_[static_cast<std::size_t>(axis)];
    const double limit = precise ? handover_ : 0.9 * handover_;
    precise = std::abs(signal[axis]) <= limit;
  }
}

Eigen::Vector3d RangeChoice::pick(double coarse, double precise) const {
  return {precise_[0] ? precise : coarse, precise_[1] ? precise : coarse, precise_[2] ? precise : coarse};
}

Eigen::Vector3d white_noise(Stream& stream, const Eigen::Vector3d& density, double rate_hz) {
  if (density.isZero(0.0)) return Eigen::Vector3d::Zero();
  return (density * std::sqrt(rate_hz)).cwiseProduct(normals(stream, 1.0));
}

Eigen::Vector3d quantise(const Eigen::Vector3d& input, const Eigen::Vector3d& quantum) {
  Eigen::Vector3d output = input;
  for (int axis = 0; axis < 3; ++axis) {
    if (quantum[axis] > 0.0) output[axis] = std::round(input[axis] / quantum[axis]) * quantum[axis];
  }
  return output;
}

}  // namespace tumble::sim
