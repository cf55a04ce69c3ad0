// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/random/stream.hpp"

/// The stages of an inertial sensor's error model, one triad each, in the order in which `simulate_imu` applies them.
/// Every stage that is off returns its input, bit for bit.
namespace tumble::sim {

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

/// Bias: a turn-on value (normal), an in-run instability (first-order Gauss-Markov, started in its stationary state)
/// and a random walk.
class Bias {
 public:
  struct Params {
    double turn_on = 0.0;      ///< standard deviation [unit of the signal]
    double in_run = 0.0;       ///< stationary standard deviation
    double in_run_s = 100.0;   ///< correlation time
    double walk_sqrt_s = 0.0;  ///< standard deviation after one second
  };
  Bias(const Params& params, double period_s, Stream& stream);
  /// The bias in force now; then advances by one period.
  Eigen::Vector3d next(Stream& stream);

 private:
  double decay_, in_run_step_, walk_step_;
  Eigen::Vector3d constant_ = Eigen::Vector3d::Zero(), in_run_ = Eigen::Vector3d::Zero(),
                  walk_ = Eigen::Vector3d::Zero();
};

/// White noise of `density` [unit / sqrt(Hz)] sampled at `rate_hz`: standard deviation density * sqrt(rate).
Eigen::Vector3d white_noise(Stream& stream, double density, double rate_hz);

/// Clamps each axis to +-rail; sets bit `first_bit + axis` of `flags` where it did. A rail of 0 is off.
Eigen::Vector3d apply_rail(const Eigen::Vector3d& input, double rail, int first_bit, std::uint8_t& flags);

/// Rounds each axis to the nearest multiple of `quantum`; 0 is off.
Eigen::Vector3d quantise(const Eigen::Vector3d& input, double quantum);

}  // namespace tumble::sim
