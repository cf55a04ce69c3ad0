// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "tumble/angular_velocity/rail_detector.hpp"

namespace tumble {

/// What a window lost that met the rail for a part of its length only: its mean lies below the rail and is a reading
/// after all, a little short.
struct SubsampleSaturation {
  bool saturated = false;
  double lost_rad_s = 0.0;   ///< expected |truth| - |reading|
  double sigma_rad_s = 0.0;  ///< its standard deviation
};

/// Loss of a flagged reading from its free neighbour. A rate that passes the rail c with constant slope within the
/// window (D per window) and in the neighbouring one: with the clipped share p of the window the reading is
/// m = c - (1-p)^2 D/2, the loss p^2 D/2 and the neighbour m + p^2 D/2 - D; p follows from (c - m) / (m - neighbour) in
/// closed form. None when the reading stands at the rail, when it is within its noise of the neighbour, or when
/// more than kShareMax of the window is hidden.
/// `neighbour_rad_s`: the smaller of the neighbours' readings, signed so that the rail is positive. What it does not
/// model: a slope that changes within the two windows; sigma allows for it (measured on impacts of tumbling bodies).
SubsampleSaturation subsample_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                         double noise_rad_s);

/// The smaller of what the samples beside (null where there is none) read by `read`, of one that is flagged on the axis
/// only where the step to it is twice what `reading_rad_s` lies below the rail, so that most of its window was free;
/// the rail where there is none. A rate of constant slope that passes the rail in this window was free in the one
/// before; readings that sink one by one along a tilted rail, all of them flagged, are no rates. rails.md (R70).
template <class Read>
double free_neighbour(double reading_rad_s, double rail_rad_s, int axis, const ImuSample* before,
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
