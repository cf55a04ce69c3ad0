// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "tumble/angular_velocity/detail/rail_detector.hpp"

namespace tumble {

/// SubsampleSaturation is the saturation deficit of a reading whose averaging window is saturated during a part of its
/// length. Such a reading is below the saturation limit, and slightly smaller than the true mean.
struct SubsampleSaturation {
  bool saturated = false;
  double expected_deficit_rad_s = 0.0;  ///< expected |truth| - |reading|
  double sigma_rad_s = 0.0;             ///< standard deviation of the saturation deficit
};

/// Estimates the saturation deficit of a partly saturated reading from its unsaturated neighbour. The model is a rate
/// with constant slope (D per window) that passes the saturation limit c within two successive windows. If the fraction
/// p of the window is clipped, the reading is m = c - (1-p)^2 D/2. The saturation deficit is p^2 D/2, and the neighbour
/// reads m + p^2 D/2 - D. The fraction p follows from (c - m) / (m - neighbour) in closed form. The saturation deficit
/// is zero if the reading is at the saturation limit or within noise of the neighbour. The saturation deficit is also
/// zero if more than kSaturatedFractionMax of the window is clipped. The argument `neighbour_rad_s` is the smaller of
/// the neighbours' readings, with a sign for which the saturation limit is positive. The standard deviation sigma_rad_s
/// covers a change of slope within the two windows (measured on impacts of tumbling bodies).
SubsampleSaturation subsample_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                         double noise_rad_s);

/// Returns the smaller reading of the neighbours `before` and `after`, which may be null. The function `read` converts
/// the angular velocity of a neighbour to a reading. Returns the saturation limit if there is no usable neighbour. The
/// function uses a flagged neighbour only if most of the neighbour's window was unsaturated. The window of a flagged
/// neighbour was mostly unsaturated if its reading differs by twice the distance of `reading_rad_s` from the saturation
/// limit. A rate of constant slope that passes the saturation limit in the current window was unsaturated in the window
/// before. Flagged readings that decrease along a tilted plane do not measure the rate. See rails.md (R70).
template <class Read>
double unsaturated_neighbour(double reading_rad_s, double rail_rad_s, int axis, const ImuSample* before,
                             const ImuSample* after, const Read& read) {
  double smallest = rail_rad_s;
  for (const ImuSample* beside : {before, after}) {
    if (beside == nullptr) continue;
    const double there = read(beside->angular_velocity_rad_s);
    const bool flagged = (beside->device_clip_flags >> axis & 1u) != 0;
    if (!flagged || reading_rad_s - there > 2.0 * (rail_rad_s - reading_rad_s)) smallest = std::min(smallest, there);
  }
  return smallest;
}

}  // namespace tumble
