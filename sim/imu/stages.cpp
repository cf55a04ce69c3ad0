// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/stages.hpp"

#include <cmath>
#include <numbers>

namespace tumble::sim {

namespace {

Eigen::Vector3d normals(Stream& stream, double sigma) {
  if (sigma == 0.0) return Eigen::Vector3d::Zero();
  const double x = stream.normal(), y = stream.normal(), z = stream.normal();
  return sigma * Eigen::Vector3d(x, y, z);
}

}  // namespace

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
  if (!started_) {  // transposed direct form II in its steady state for this input
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

Bias::Bias(const Params& params, double period_s, Stream& stream)
    : decay_(std::exp(-period_s / params.in_run_s)),
      in_run_step_(params.in_run * std::sqrt(1.0 - decay_ * decay_)),
      walk_step_(params.walk_sqrt_s * std::sqrt(period_s)),
      constant_(normals(stream, params.turn_on)),
      in_run_(normals(stream, params.in_run)) {}

Eigen::Vector3d Bias::next(Stream& stream) {
  const Eigen::Vector3d now = constant_ + in_run_ + walk_;
  in_run_ = decay_ * in_run_ + normals(stream, in_run_step_);
  walk_ += normals(stream, walk_step_);
  return now;
}

Eigen::Vector3d white_noise(Stream& stream, double density, double rate_hz) {
  return normals(stream, density * std::sqrt(rate_hz));
}

Eigen::Vector3d apply_rail(const Eigen::Vector3d& input, double rail, int first_bit, std::uint8_t& flags) {
  if (rail <= 0.0) return input;
  Eigen::Vector3d output = input;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(input[axis]) <= rail) continue;
    output[axis] = std::copysign(rail, input[axis]);
    flags = static_cast<std::uint8_t>(flags | (1u << (first_bit + axis)));
  }
  return output;
}

Eigen::Vector3d quantise(const Eigen::Vector3d& input, double quantum) {
  if (quantum <= 0.0) return input;
  return (input / quantum).array().round().matrix() * quantum;
}

}  // namespace tumble::sim
