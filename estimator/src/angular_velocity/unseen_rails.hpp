// SPDX-License-Identifier: BSD-3-Clause
// Readings that may stand at a rail which too few of them show.
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/least_rails.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"

namespace tumble {

/// Doubts readings near the rails of the other elements on an element whose own rail was not seen: too few samples show
/// no plane. Such a reading counts as one that may be short by as much as it steps to its neighbours. None that was
/// read far beyond, by `least`. Sets RateObservation::lone anew.
void doubt_unseen_rails(const RailPlanes& planes, const LeastRails& least, double noise_rad_s, const ImuSample* before,
                        RateObservation& now, const ImuSample* after);

/// The same of whole segments: readings that stay at a top near the rails of the other elements, of an element whose
/// own rail was not seen on that side, may hide what the motion had risen to between the slopes at which they were
/// entered and left. `offset_share`: of the rail, how far elements differ (RailPlaneFinder::Params). Nothing for a
/// device that flags what it clips, or where no rail was seen, or where the element was read far beyond. Sets
/// RateObservation::doubted. O(N).
void doubt_motion_plateaus(const RailPlanes& planes, const LeastRails& least, double offset_share, double noise_rad_s,
                           std::span<RateObservation> observations);

}  // namespace tumble
