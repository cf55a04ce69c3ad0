// SPDX-License-Identifier: BSD-3-Clause
// possible_saturation.hpp finds readings that may be saturated at a level that too few samples reach for its detection.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Marks readings of a sensing element with unknown saturation level if they are near the known levels of other
/// elements. A few saturated samples do not determine a saturation plane. The saturation deficit of a marked reading
/// may be as large as the step to the previous or next reading. Readings below `least`, the smallest possible
/// saturation level, remain unmarked. The function resets RateObservation::isolated_high_axes.
void inflate_possible_saturation(const RailPlanes& planes, const MinSaturationLevels& least, double noise_rad_s,
                                 const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Marks flat maxima of the readings that may hide a saturated peak. Cost: O(N). `offset_sigma_ratio` is the difference
/// between the saturation levels of two sensing elements, as a fraction (RailPlaneFinder::Params). The function has no
/// effect if the device flags clipping, or if no saturation level is known. The function also has no effect if the
/// sensing element has reported far higher readings. The function sets RateObservation::suspect.
void inflate_motion_plateaus(const RailPlanes& planes, const MinSaturationLevels& least, double offset_sigma_ratio,
                             double noise_rad_s, std::span<RateObservation> observations);

}  // namespace tumble
