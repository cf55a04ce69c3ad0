// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/partial_saturation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

// largest saturated fraction of the averaging window for which a reading still determines the slope of the rate
constexpr double kSaturatedFractionMax = 0.85;
constexpr double kDeficitSigmaRatio = 0.5, kDepthSigmaRatio = 0.25, kDepthMax = 1.0;

}  // namespace

// The rate is assumed to cross the saturation level with constant slope: rails.md (R69), (R70).
PartialSaturation partial_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                     double noise_rad_s) {
  const double depth = rail_rad_s - reading_rad_s, slope = reading_rad_s - neighbour_rad_s;
  // Noise lowers a fully saturated reading by less than a tenth of the noise's standard deviation, because the device
  // clips the sum of rate and noise.
  if (!(depth > 0.1 * noise_rad_s)) return {};
  // If the device compensates misalignment after clipping, rotation about other axes slowly changes a fully saturated
  // reading. Only a change above the noise indicates partial saturation.
  if (!(slope > noise_rad_s)) return {};
  double share = 0.0;  // rails.md (R71)
  if (slope > 2.0 * depth) {
    const double ratio = depth / slope;
    const double root = std::sqrt(std::max(0.0, 1.0 - (1.0 + ratio) * (1.0 - 2.0 * ratio)));
    share = (1.0 - root) / (1.0 + ratio);
  }
  if (share > kSaturatedFractionMax) return {};
  // See rails.md (R72), (R73).
  const double free = 1.0 - share, lost = share * share / (free * free) * depth;
  return {true, lost,
          std::hypot(2.0 * noise_rad_s, kDeficitSigmaRatio * lost + kDepthSigmaRatio * std::min(depth, kDepthMax))};
}

}  // namespace tumble
