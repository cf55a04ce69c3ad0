// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/random/stream.hpp"

/// The classes and functions in stages.hpp simulate single sensor errors. An error that is switched off leaves its
/// input bit-identical, and draws no random numbers.
namespace tumble::sim {

Eigen::Vector3d normals(Stream& stream, double sigma);

/// Draws a normally distributed number, clamped to three standard deviations. If `sigma` is 0, the result is 0, and no
/// random number is drawn.
double bounded_normal(Stream& stream, double sigma);

/// DelayLine delays a signal by `delay_s`. Before the time `delay_s`, the output is the first input. The output is
/// linearly interpolated between samples, which preserves the integral of the signal.
class DelayLine {
 public:
  DelayLine(double delay_s, double rate_hz);
  Eigen::Vector3d operator()(const Eigen::Vector3d& input);

 private:
  double fraction_ = 0.0;
  std::vector<Eigen::Vector3d> past_;  ///< ring buffer; empty if off
  std::size_t next_ = 0;
  bool started_ = false;
};

/// LowPass is a second-order low-pass filter (Butterworth, bilinear transform with prewarped cutoff) with gain 1 for a
/// constant signal. The filter starts in the steady state of the first sample. A cutoff frequency of 0 switches the
/// filter off.
class LowPass {
 public:
  /// `cutoff_hz` must be below half of `rate_hz`.
  LowPass(double cutoff_hz, double rate_hz);
  Eigen::Vector3d operator()(const Eigen::Vector3d& input);

 private:
  bool on_;
  bool started_ = false;
  double b0_ = 1.0, b1_ = 0.0, b2_ = 0.0, a1_ = 0.0, a2_ = 0.0;
  Eigen::Vector3d s1_ = Eigen::Vector3d::Zero(), s2_ = Eigen::Vector3d::Zero();
};

/// Draws a matrix of scale and misalignment errors. The diagonal entries are 1 plus a scale error, and the other six
/// entries are independent small angles. All errors are normally distributed.
Eigen::Matrix3d draw_axis_errors(Stream& stream, double scale_sigma, double misalignment_sigma_rad);

/// RangeChoice selects, separately for each axis, the precise or the coarse range of a sensor with two ranges. An axis
/// switches to the coarse range when the signal exceeds `handover`, and to the precise range when the signal is below
/// 90 % of `handover`. If `handover` is 0, all axes use the coarse range.
class RangeChoice {
 public:
  explicit RangeChoice(double handover) : handover_(handover) {}
  void update(const Eigen::Vector3d& signal);
  Eigen::Vector3d pick(double coarse, double precise) const;

 private:
  double handover_;
  std::array<bool, 3> precise_ = {false, false, false};
};

/// Draws white noise with the spectral density `density` [unit / sqrt(Hz)]. At the sample rate `rate_hz`, the noise has
/// the standard deviation density * sqrt(rate_hz).
Eigen::Vector3d white_noise(Stream& stream, const Eigen::Vector3d& density, double rate_hz);

Eigen::Vector3d quantise(const Eigen::Vector3d& input, const Eigen::Vector3d& quantum);

}  // namespace tumble::sim
