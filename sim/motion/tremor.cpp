// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/tremor.hpp"

#include <cmath>
#include <numbers>

namespace tumble::sim {

Tremor::Tremor(Stream& stream, double rms, double lowest_hz, double highest_hz) {
  double power = 0.0;
  for (Wave& wave : waves_) {
    const double hz = lowest_hz * std::pow(highest_hz / lowest_hz, stream.uniform());
    wave = {2.0 * std::numbers::pi * hz, stream.uniform(0.0, 2.0 * std::numbers::pi), 1.0 / hz};
    power += wave.amplitude * wave.amplitude / 2.0;
  }
  for (Wave& wave : waves_) wave.amplitude *= rms / std::sqrt(power);
}

double Tremor::at(double time_s) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.w_rad_s * time_s + wave.phase_rad);
  return sum;
}

}  // namespace tumble::sim
