// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Where the output of a triad stops, in the ways seen on real devices. `clamp`: at `level`, which may lie above the
/// stated range. `plateau`: the level differs from axis to axis and sign to sign (drawn once) and from one clipping to
/// the next (drawn when the signal has fallen below 90 % of the level again). `wrap`: a reading beyond the level comes
/// out with the other sign, as when a 16-bit word overflows. `slow_recovery`: a clipped axis charges an offset of its
/// sign, `recovery_share` of the level in the limit, with the time `recovery_s`; it fades with the same time
/// afterwards. What it does not model: a rail that depends on temperature, a device that stops for good.
class Rail {
 public:
  struct Params {
    double level = 0.0;         ///< [unit of the signal]; 0: no rail
    double axis_spread = 0.0;   ///< standard deviation, cut at three of them
    double event_spread = 0.0;  ///< the same
    bool wrap = false;
    double recovery_s = 0.0;      ///< 0: at once
    double recovery_share = 0.0;  ///< of the level
  };
  /// `period_s`: from call to call. Draws from `stream` only when a spread is above 0.
  Rail(const Params& params, double period_s, const Stream& stream);

  /// Applies the rail to each axis and sets bit `first_bit + axis` of `flags` where it acted.
  Eigen::Vector3d operator()(const Eigen::Vector3d& input, int first_bit, std::uint8_t& flags);

 private:
  struct Axis {
    std::array<double, 2> base{}, level{};  ///< of the positive and the negative side
    std::array<bool, 2> event{};            ///< a clipping that has not ended yet
    double offset = 0.0;                    ///< what a clipping has left
  };
  double apply(double input, Axis& axis, bool& acted);
  double draw_level(double base);

  Params params_;
  double fading_;
  Stream stream_;
  std::array<Axis, 3> axes_;
};

}  // namespace tumble::sim
