// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/subsample_saturation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

// Hidden share of the window above which the free part says too little of the slope.
constexpr double kShareMax = 0.85;
// Spread of the loss: share of itself, and share of what the reading lies below the rail (up to 1 rad/s).
constexpr double kOfLoss = 0.5, kOfDepth = 0.25, kDepthMax = 1.0;

}  // namespace

// A rate of constant slope that passes the rail: rails.md (R69), (R70).
SubsampleSaturation subsample_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                         double noise_rad_s) {
  const double depth = rail_rad_s - reading_rad_s, slope = reading_rad_s - neighbour_rad_s;
  // a mean of clipped values stands on the rail exactly; noise before the rail lowers it by less than this
  if (!(depth > 0.1 * noise_rad_s)) return {};
  // nor does a rate cross the rail that does not move: a rail that is tilted a little passes for a plateau that sinks
  if (!(slope > noise_rad_s)) return {};
  double share = 0.0;  // rails.md (R71)
  if (slope > 2.0 * depth) {
    const double ratio = depth / slope;
    const double root = std::sqrt(std::max(0.0, 1.0 - (1.0 + ratio) * (1.0 - 2.0 * ratio)));
    share = (1.0 - root) / (1.0 + ratio);
  }
  if (share > kShareMax) return {};
  // rails.md (R72), (R73)
  const double free = 1.0 - share, lost = share * share / (free * free) * depth;
  return {true, lost, std::hypot(2.0 * noise_rad_s, kOfLoss * lost + kOfDepth * std::min(depth, kDepthMax))};
}

}  // namespace tumble
