// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Tremor is the random tremor of a hand as a smooth function of time: a sum of sinusoids with random phases. The
/// frequencies of the sinusoids are log-uniform between two limits, and the amplitudes are inversely proportional to
/// the frequencies.
class Tremor {
 public:
  Tremor(Stream& stream, double rms, double lowest_hz, double highest_hz);
  double at(double time_s) const;

 private:
  struct Wave {
    double w_rad_s, phase_rad, amplitude;
  };
  std::array<Wave, 8> waves_;
};

}  // namespace tumble::sim
