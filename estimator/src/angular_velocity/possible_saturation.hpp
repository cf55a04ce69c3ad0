// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Marks readings near the known saturation levels of other sensing elements, if the level of their own element is
/// unknown. The assumed saturation deficit of a marked reading is up to the step to the previous or next reading.
/// Readings below `least`, the smallest possible saturation level, remain unmarked.
void inflate_possible_saturation(const RailPlanes& planes, const MinSaturationLevels& least, double noise_rad_s,
                                 const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Marks flat maxima of the readings that may hide a saturated peak. Cost: O(N). `offset_sigma_ratio` is the standard
/// deviation of the relative difference between saturation levels (RailPlaneFinder::Params). The function has no effect
/// if the device flags clipping, or if no saturation level is known.
void inflate_motion_plateaus(const RailPlanes& planes, const MinSaturationLevels& least, double offset_sigma_ratio,
                             double noise_rad_s, std::span<RateObservation> observations);

}  // namespace tumble
