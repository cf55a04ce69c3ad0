// SPDX-License-Identifier: BSD-3-Clause
// Readings that may be at a saturation level with too few samples for detection.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/least_rails.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Marks readings of an element without a known saturation level that are near the levels of other elements. Too few
/// saturated samples reveal no plane. The possible saturation deficit of a marked reading is its step to the
/// neighbours. Readings refuted by `least` are excluded. Resets RateObservation::lone.
void inflate_possible_saturation(const RailPlanes& planes, const LeastRails& least, double noise_rad_s,
                                 const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Marks whole segments near a maximum, which may hide a peak between the slopes before and after. `offset_share` is
/// the difference between elements as a fraction of the saturation level (RailPlaneFinder::Params). The function has no
/// effect for a device that flags clipping, without a known saturation level, or if the sensing element has read far
/// higher values. Sets RateObservation::suspect. Cost: O(N).
void inflate_motion_plateaus(const RailPlanes& planes, const LeastRails& least, double offset_share, double noise_rad_s,
                             std::span<RateObservation> observations);

}  // namespace tumble
