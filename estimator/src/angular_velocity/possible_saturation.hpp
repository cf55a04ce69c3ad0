// SPDX-License-Identifier: BSD-3-Clause
// possible_saturation.hpp finds readings at a saturation level that has too few samples for detection.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Marks readings of a sensing element without a known saturation level if the readings are near the levels of other
/// elements. Marking is needed because few saturated samples do not reveal a saturation plane. The possible saturation
/// deficit of a marked reading is its step to the neighbours. Readings that `least` excludes as saturation levels are
/// not marked. The function resets RateObservation::isolated_high_axes.
void inflate_possible_saturation(const RailPlanes& planes, const MinSaturationLevels& least, double noise_rad_s,
                                 const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Marks whole segments of readings near a maximum, which may hide a peak between the slopes before and after the
/// segment. Cost: O(N). `offset_sigma_ratio` is the difference between sensing elements as a fraction of the saturation
/// level (RailPlaneFinder::Params). The function has no effect if the device flags clipping or no saturation level is
/// known. The function also has no effect if the sensing element has read far higher values. The function sets
/// RateObservation::suspect.
void inflate_motion_plateaus(const RailPlanes& planes, const MinSaturationLevels& least, double offset_sigma_ratio,
                             double noise_rad_s, std::span<RateObservation> observations);

}  // namespace tumble
