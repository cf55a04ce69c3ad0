// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Rail simulates the saturation of a gyro or accelerometer in one of these forms:
/// - `clamp`: the output stops at `level`, which may exceed the stated range.
/// - `plateau`: the level differs between axes and signs, and between clipping events.
/// - `wrap`: a reading beyond the level gets the opposite sign, like the overflow of a 16-bit integer.
/// - `slow_recovery`: a clipped axis accumulates an offset with the sign of the signal, up to `recovery_share` of the
///   level, with time constant `recovery_s`.
///
/// The simulation does not include saturation levels that depend on temperature, or sensors that stop after saturation.
class Rail {
 public:
  struct Params {
    double level = 0.0;         ///< [unit of the signal]; 0: none
    double axis_spread = 0.0;   ///< standard deviation [unit of the signal]
    double event_spread = 0.0;  ///< standard deviation [unit of the signal]
    bool wrap = false;
    double recovery_s = 0.0;      ///< time constant; 0: no offset
    double recovery_share = 0.0;  ///< fraction of the level
  };
  Rail(const Params& params, double period_s, const Stream& stream);

  Eigen::Vector3d operator()(const Eigen::Vector3d& input, int first_bit, std::uint8_t& flags);

 private:
  struct Axis {
    std::array<double, 2> base{}, level{};  ///< positive and negative side
    std::array<bool, 2> event{};
    double offset = 0.0;
  };
  double apply(double input, Axis& axis, bool& acted);
  double draw_level(double base);

  Params params_;
  double fading_;
  Stream stream_;
  std::array<Axis, 3> axes_;
};

}  // namespace tumble::sim
