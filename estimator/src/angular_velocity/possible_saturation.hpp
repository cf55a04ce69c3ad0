// SPDX-License-Identifier: BSD-3-Clause
// possible_saturation.hpp finds readings that may be saturated although too few readings reached the saturation level
// to detect it.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

/// Marks high readings of a sensing element whose saturation level is unknown. A reading is high if it is near the
/// known levels of other elements. A few saturated samples do not determine a saturation plane. The assumed saturation
/// deficit of a marked reading is up to the step to the previous or next reading. Readings below `least`, the smallest
/// possible saturation level, remain unmarked. The function resets RateObservation::isolated_high_axes.
void inflate_possible_saturation(const RailPlanes& planes, const MinSaturationLevels& least, double noise_rad_s,
                                 const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Marks flat maxima of the readings that may hide a saturated peak, in RateObservation::suspect. Cost: O(N).
/// `offset_sigma_ratio` is the standard deviation of the relative difference between saturation levels
/// (RailPlaneFinder::Params). The function has no effect if the device flags clipping, or if no saturation level is
/// known. A sensing element that reported far higher readings is not marked.
void inflate_motion_plateaus(const RailPlanes& planes, const MinSaturationLevels& least, double offset_sigma_ratio,
                             double noise_rad_s, std::span<RateObservation> observations);

}  // namespace tumble
