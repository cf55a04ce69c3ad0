// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/relief.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::sim {

Undulation::Undulation(Stream& stream, double rms_m, double shortest_m, double longest_m) {
  constexpr int kWaves = 24;
  double power = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double length_m = shortest_m * std::pow(longest_m / shortest_m, stream.uniform());
    const double direction = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const double k = 2.0 * std::numbers::pi / length_m;
    waves_.push_back(
        {k * std::cos(direction), k * std::sin(direction), stream.uniform(0.0, 2.0 * std::numbers::pi), length_m});
    power += length_m * length_m / 2.0;
  }
  for (Wave& wave : waves_) wave.amplitude_m *= rms_m / std::sqrt(power);
}

double Undulation::height_m(double x_m, double y_m) const {
  double sum_m = 0.0;
  for (const Wave& wave : waves_) sum_m += wave.amplitude_m * std::cos(wave.kx * x_m + wave.ky * y_m + wave.phase);
  return sum_m;
}

Bumps::Bumps(Stream& stream, int count, double height_m, double half_extent_m) {
  for (int i = 0; i < count; ++i) {
    Bump bump;
    bump.x_m = stream.uniform(-half_extent_m, half_extent_m);
    bump.y_m = stream.uniform(-half_extent_m, half_extent_m);
    bump.height_m = stream.uniform(-height_m, height_m);
    bump.sigma_m = stream.uniform(0.2, 0.7);
    bumps_.push_back(bump);
  }
}

void Bumps::add_to(std::vector<double>& grid_m, int side, double cell_m) const {
  const double half_m = 0.5 * (side - 1) * cell_m;
  for (const Bump& bump : bumps_) {
    const double reach_m = 4.0 * bump.sigma_m;  // beyond it less than 0.04 % of the height
    const auto index = [&](double at_m) {
      return std::clamp(static_cast<int>(std::lround((at_m + half_m) / cell_m)), 0, side - 1);
    };
    for (int row = index(bump.y_m - reach_m); row <= index(bump.y_m + reach_m); ++row) {
      for (int column = index(bump.x_m - reach_m); column <= index(bump.x_m + reach_m); ++column) {
        const double dx = column * cell_m - half_m - bump.x_m, dy = row * cell_m - half_m - bump.y_m;
        grid_m[static_cast<std::size_t>(row) * side + column] +=
            bump.height_m * std::exp(-0.5 * (dx * dx + dy * dy) / (bump.sigma_m * bump.sigma_m));
      }
    }
  }
}

}  // namespace tumble::sim
