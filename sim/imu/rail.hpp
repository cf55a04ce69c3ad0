// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Rail models the saturation of a triad's output, in the forms that real devices show.
/// - `clamp`: the output stops at `level`, which may exceed the stated range.
/// - `plateau`: the level differs between axes and signs, and between clipping events; a new level is drawn after the
///   signal has fallen below 90 % of the level.
/// - `wrap`: a reading beyond the level appears with the opposite sign, as when a 16-bit word overflows.
/// - `slow_recovery`: a clipped axis accumulates an offset with the sign of the signal, up to `recovery_share` of the
///   level, with time constant `recovery_s`.
///
/// The model excludes saturation levels that depend on temperature, and devices that stop after saturation.
class Rail {
 public:
  struct Params {
    double level = 0.0;         ///< [unit of the signal]; 0: no saturation
    double axis_spread = 0.0;   ///< standard deviation, truncated at three standard deviations
    double event_spread = 0.0;  ///< standard deviation, truncated at three standard deviations
    bool wrap = false;
    double recovery_s = 0.0;      ///< time constant of the offset after clipping; 0: no offset
    double recovery_share = 0.0;  ///< offset after clipping, as a fraction of the level
  };
  Rail(const Params& params, double period_s, const Stream& stream);

  /// Applies saturation to each axis and sets bit `first_bit + axis` of `flags` for saturated axes.
  Eigen::Vector3d operator()(const Eigen::Vector3d& input, int first_bit, std::uint8_t& flags);

 private:
  struct Axis {
    std::array<double, 2> base{}, level{};  ///< level of the positive and of the negative side
    std::array<bool, 2> event{};            ///< true while a clipping event lasts
    double offset = 0.0;                    ///< offset left by clipping
  };
  double apply(double input, Axis& axis, bool& acted);
  double draw_level(double base);

  Params params_;
  double fading_;
  Stream stream_;
  std::array<Axis, 3> axes_;
};

}  // namespace tumble::sim
