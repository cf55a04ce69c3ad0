// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {

/// LowPass is a second-order Butterworth low-pass filter (bilinear transform, corner frequency sqrt(2) / (2 pi tau)).
/// Until the time tau has passed, the output is the mean of all inputs.
template <int Rows>
struct LowPass {
  using Vector = Eigen::Matrix<double, Rows, 1>;

  Vector value = Vector::Zero();
  Vector normalised_derivative = Vector::Zero();  ///< derivative divided by the corner's angular frequency
  Vector input = Vector::Zero();                  ///< the last input
  double averaged_duration_s = 0.0;
  double samples = 0.0;

  /// `dt_s` is the time since the previous input, and `warp` is the result of low_pass_prewarp().
  void advance(const Vector& next, double tau_s, double dt_s, double warp) {
    if (averaged_duration_s < tau_s) {
      samples += 1.0;
      averaged_duration_s += dt_s;
      value += (next - value) / samples;
    } else {
      const double damping = std::numbers::sqrt2 * warp;
      const Vector rise =
          ((1.0 - damping - warp * warp) * normalised_derivative + warp * (input + next - 2.0 * value)) /
          (1.0 + damping + warp * warp);
      value += warp * (normalised_derivative + rise);
      normalised_derivative = rise;
    }
    input = next;
  }

  bool operator==(const LowPass&) const = default;
};

/// Returns tan(pi * corner frequency * dt), bounded for sample periods much longer than tau.
inline double low_pass_prewarp(double tau_s, double dt_s) {
  return std::tan(std::min(dt_s / (std::numbers::sqrt2 * tau_s), 1.5));
}

}  // namespace tumble
