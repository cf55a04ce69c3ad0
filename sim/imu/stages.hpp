// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/random/stream.hpp"

/// The small stages of an inertial sensor's error model, one triad each (bias.hpp and rail.hpp hold the larger ones).
/// Every stage that is off returns its input, bit for bit, and draws nothing.
namespace tumble::sim {

/// Three normal numbers of this standard deviation; zero, and nothing drawn, for 0.
Eigen::Vector3d normals(Stream& stream, double sigma);

/// One normal number of this standard deviation, cut at three of them; 0, and nothing drawn, for 0.
double bounded_normal(Stream& stream, double sigma);

/// A signal that arrives late by `delay_s`, held at its first value until then; between samples it is interpolated
/// linearly. The whole of it arrives: sums over a long time are kept. A delay of 0 is off.
class DelayLine {
 public:
  DelayLine(double delay_s, double rate_hz);
  Eigen::Vector3d operator()(const Eigen::Vector3d& input);

 private:
  double fraction_ = 0.0;              ///< of a sample
  std::vector<Eigen::Vector3d> past_;  ///< ring of the last samples; empty: off
  std::size_t next_ = 0;
  bool started_ = false;
};

/// Low-pass of second order (Butterworth, bilinear transform with the cutoff prewarped); gain 1 at rest. The first
/// sample sets the steady state. A cutoff of 0 is off.
class LowPass {
 public:
  /// `cutoff_hz` below half of `rate_hz`.
  LowPass(double cutoff_hz, double rate_hz);
  Eigen::Vector3d operator()(const Eigen::Vector3d& input);

 private:
  bool on_;
  bool started_ = false;
  double b0_ = 1.0, b1_ = 0.0, b2_ = 0.0, a1_ = 0.0, a2_ = 0.0;
  Eigen::Vector3d s1_ = Eigen::Vector3d::Zero(), s2_ = Eigen::Vector3d::Zero();
};

/// Scale and misalignment of a triad: 1 + scale errors on the diagonal, six independent small angles off it, all
/// normal. Exactly the identity where both are 0.
Eigen::Matrix3d draw_axis_errors(Stream& stream, double scale_sigma, double misalignment_sigma_rad);

/// Which of two parts of a device answers for each axis: the precise one up to `handover`, the coarse one beyond, back
/// to the precise one below `handover` less a tenth. A handover of 0: the coarse one always. The change is seamless:
/// bias, scale and axes stay, noise and quantum change.
class RangeChoice {
 public:
  explicit RangeChoice(double handover) : handover_(handover) {}
  /// Chooses for each axis by its signal before noise and rail.
  void update(const Eigen::Vector3d& signal);
  /// One number for each axis: of the part that answers for it.
  Eigen::Vector3d pick(double coarse, double precise) const;

 private:
  double handover_;
  std::array<bool, 3> precise_ = {false, false, false};
};

/// White noise of `density` [unit / sqrt(Hz)] for each axis, sampled at `rate_hz`: standard deviation density *
/// sqrt(rate).
Eigen::Vector3d white_noise(Stream& stream, const Eigen::Vector3d& density, double rate_hz);

/// Rounds each axis to the nearest multiple of its `quantum`; 0 is off.
Eigen::Vector3d quantise(const Eigen::Vector3d& input, const Eigen::Vector3d& quantum);

}  // namespace tumble::sim
