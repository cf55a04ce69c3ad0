// SPDX-License-Identifier: BSD-3-Clause
// Readings that may be at a saturation level with too few samples for detection.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/least_rails.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Marks readings near the levels of other elements, on an element without a known level: too few samples reveal no
/// plane. The possible deficit of such a reading is its step to the neighbours. Readings refuted by `least` are
/// excluded. Resets RateObservation::lone.
void doubt_unseen_rails(const RailPlanes& planes, const LeastRails& least, double noise_rad_s, const ImuSample* before,
                        RateObservation& now, const ImuSample* after);

/// Same for whole segments near a maximum: they may hide a peak between the slopes before and after. `offset_share`:
/// difference between elements as a fraction of the level (RailPlaneFinder::Params). Has no effect for a device that
/// flags clipping, without a known level, or if the element has read far higher values. Sets RateObservation::doubted.
/// O(N).
void doubt_motion_plateaus(const RailPlanes& planes, const LeastRails& least, double offset_share, double noise_rad_s,
                           std::span<RateObservation> observations);

}  // namespace tumble
