// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/relief.hpp"

#include <cmath>
#include <numbers>

namespace tumble::sim {

Relief::Relief(Stream& stream, const ReliefSpectrum& spectrum) {
  constexpr int kWaves = 32;
  double power_m2 = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double length_m = spectrum.shortest_m * std::pow(spectrum.longest_m / spectrum.shortest_m, stream.uniform());
    const double turn = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const double direction = spectrum.ruled ? 0.0 : turn;
    const double k = 2.0 * std::numbers::pi / length_m;
    // Log-uniform wavelengths have the density 1/k in the wave number k. For a power proportional to k^-exponent, the
    // squared amplitude must therefore be proportional to k^(1 - exponent).
    const double amplitude_m = std::pow(length_m, 0.5 * (spectrum.exponent - 1.0));
    waves_.push_back(
        {k * std::cos(direction), k * std::sin(direction), stream.uniform(0.0, 2.0 * std::numbers::pi), amplitude_m});
    power_m2 += amplitude_m * amplitude_m / 2.0;
  }
  for (Wave& wave : waves_) wave.amplitude_m *= spectrum.rms_m / std::sqrt(power_m2);
}

double Relief::height_m(double x_m, double y_m) const {
  double sum_m = 0.0;
  for (const Wave& wave : waves_) sum_m += wave.amplitude_m * std::cos(wave.kx * x_m + wave.ky * y_m + wave.phase);
  return sum_m;
}

void add_bumps(Ground& ground, Stream& stream, int count, double height_m) {
  const double half_m = ground.half_extent_m();
  for (int i = 0; i < count; ++i) {
    const double x_m = stream.uniform(-half_m, half_m), y_m = stream.uniform(-half_m, half_m);
    const double top_m = stream.uniform(-height_m, height_m);
    const double sigma_m = stream.uniform(0.2, 0.7);
    ground.add_near(x_m, y_m, 4.0 * sigma_m, [&](double x, double y) {
      const double dx = x - x_m, dy = y - y_m;
      return top_m * std::exp(-0.5 * (dx * dx + dy * dy) / (sigma_m * sigma_m));
    });
  }
}

}  // namespace tumble::sim
