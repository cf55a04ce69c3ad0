// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Smooth unsteadiness: a sum of sinusoids of random phase, frequencies log-uniform between the two given, amplitudes
/// as the inverse of the frequency. A pure function of time. The root mean square over long times is the given one.
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
