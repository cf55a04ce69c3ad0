// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"

namespace tumble {

/// Saturation deficit (true rate minus reading) of a gyro reading, if the gyro is saturated during a part of the
/// averaging window.
struct PartialSaturation {
  bool saturated = false;
  double expected_saturation_deficit_rad_s = 0.0;  ///< expected |true rate| - |reading|
  double sigma_rad_s = 0.0;
};

/// Estimates the saturation deficit of a partly saturated gyro reading from an unsaturated neighbouring reading, for
/// constant angular acceleration: rails.md (R70). `neighbour_rad_s` is the smaller one of the two neighbouring
/// readings, with a sign for which the saturation limit is positive.
PartialSaturation partial_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                     double noise_rad_s);

/// Returns the smaller one of the readings of the samples `before` and `after`, which may be null: rails.md (R70).
/// `read` converts an angular velocity to the reading of a sensing element. A reading flagged as saturated is used only
/// if most of its averaging window was unsaturated. Returns the saturation limit if there is no usable neighbour.
template <class Read>
double unsaturated_neighbour_reading(double reading_rad_s, double rail_rad_s, int axis, const ImuSample* before,
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
