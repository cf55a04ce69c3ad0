// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/random/stream.hpp"

/// Parts of the simulation of sensor errors. A part that is switched off returns its input bit for bit, and draws no
/// random numbers.
namespace tumble::sim {

Eigen::Vector3d normals(Stream& stream, double sigma);

/// Draws a normally distributed number, truncated at three standard deviations. For `sigma` 0, no random number is
/// drawn.
double bounded_normal(Stream& stream, double sigma);

/// Delays a signal by `delay_s`; until the delay has passed, the output is the first value. Linear interpolation
/// between samples preserves the integral of the signal.
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

/// Second-order low-pass filter (Butterworth, bilinear transform with prewarped cutoff) with gain 1 for a constant
/// signal. The filter starts in the steady state of the first sample. A cutoff frequency of 0 switches the filter off.
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

/// Draws a matrix of scale and misalignment errors. The diagonal is 1 plus scale errors; the other entries are six
/// independent small angles. All errors are normally distributed.
Eigen::Matrix3d draw_axis_errors(Stream& stream, double scale_sigma, double misalignment_sigma_rad);

/// Selects for each axis the precise or the coarse range of a sensor with two ranges. An axis switches to the coarse
/// range when the signal exceeds `handover`, and back when the signal is below 90 % of `handover`. If `handover` is 0,
/// all axes have the coarse range.
class RangeChoice {
 public:
  explicit RangeChoice(double handover) : handover_(handover) {}
  void update(const Eigen::Vector3d& signal);
  Eigen::Vector3d pick(double coarse, double precise) const;

 private:
  double handover_;
  std::array<bool, 3> precise_ = {false, false, false};
};

/// Draws white noise of `density` [unit / sqrt(Hz)], whose standard deviation at the sample rate `rate_hz` is density *
/// sqrt(rate).
Eigen::Vector3d white_noise(Stream& stream, const Eigen::Vector3d& density, double rate_hz);

Eigen::Vector3d quantise(const Eigen::Vector3d& input, const Eigen::Vector3d& quantum);

}  // namespace tumble::sim
