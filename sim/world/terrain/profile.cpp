// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/profile.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

double SlopeProfile::length_m() const {
  return drop_m / std::tan(slope_rad);
}

double SlopeProfile::height_m(double x_m) const {
  const auto ramp = [&](double u) {
    return rounding_m * (u > 8 * rounding_m ? u / rounding_m : std::log1p(std::exp(u / rounding_m)));
  };
  return -std::tan(slope_rad) * (ramp(x_m - edge_x_m) - ramp(x_m - edge_x_m - length_m()));
}

double LedgeProfile::height_m(double x_m) const {
  const double step_m = face_m + ledge_length_m;
  double height_m = 0.0;
  for (int i = 0; i < drops; ++i) {
    const double into_m = x_m - edge_x_m - i * step_m;
    height_m -= drop_height_m * std::clamp(into_m / face_m, 0.0, 1.0);
    height_m -= std::tan(ledge_slope_rad) * std::clamp(into_m - face_m, 0.0, ledge_length_m);
  }
  return height_m;
}

}  // namespace tumble::sim
