// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Bias simulates the bias of a gyro or accelerometer, independently for each axis, as the sum of three parts:
/// - a turn-on value (normal, drawn once),
/// - in-run instability: flicker noise over three decades, from four first-order Gauss-Markov processes of equal size,
///   with correlation times a factor of ten apart (Keshner, "1/f noise", Proceedings of the IEEE 70, 1982),
/// - a random walk.
///
/// The Allan deviation of the in-run instability is flat within 5 % for averaging times from 1/200 to 1/2 of
/// `in_run_s`. In data sheets, "in-run bias stability" is the flat part of the Allan deviation (IEEE Std 952-1997,
/// annex C). The bias does not depend on temperature or earlier motion.
class Bias {
 public:
  struct Params {
    double turn_on = 0.0;      ///< standard deviation [signal unit]
    double in_run = 0.0;       ///< minimum of the Allan deviation
    double in_run_s = 1000.0;  ///< longest correlation time
    double walk_sqrt_s = 0.0;  ///< standard deviation after one second
  };
  Bias(const Params& params, double period_s, const Stream& stream);
  Eigen::Vector3d next();

  static double in_run_deviation(const Params& params, double tau_s);

 private:
  struct Process {
    double decay = 0.0, step = 0.0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };
  Stream stream_;
  double walk_step_;
  Eigen::Vector3d constant_, walk_ = Eigen::Vector3d::Zero();
  std::array<Process, 4> in_run_;
};

}  // namespace tumble::sim
