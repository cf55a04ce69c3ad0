// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/rail_detector.hpp"

namespace tumble {

/// What a window lost that met the rail for a part of its length only: its mean lies below the rail and is a reading
/// after all, a little short.
struct PartialLoss {
  bool partial = false;
  double lost_rad_s = 0.0;   ///< expected |truth| - |reading|
  double sigma_rad_s = 0.0;  ///< its standard deviation
};

/// Loss of a flagged reading from its free neighbour. A rate that passes the rail c with constant slope within the
/// window (D per window) and in the neighbouring one: with the clipped share p of the window the reading is
/// m = c - (1-p)^2 D/2, the loss p^2 D/2 and the neighbour m + p^2 D/2 - D; p follows from (c - m) / (m - neighbour) in
/// closed form. Not partial when the reading stands at the rail, when it is within its noise of the neighbour, or when
/// more than kShareMax of the window is hidden.
/// `neighbour_rad_s`: the smaller of the neighbours' readings, signed so that the rail is positive. What it does not
/// model: a slope that changes within the two windows; sigma allows for it (measured on impacts of tumbling bodies).
PartialLoss partial_loss(double reading_rad_s, double neighbour_rad_s, double rail_rad_s, double noise_rad_s);

}  // namespace tumble
