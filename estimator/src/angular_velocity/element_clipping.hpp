// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"
#include "tumble/angular_velocity/rate_model.hpp"

namespace tumble {

/// Whether the rails found, and the plateaus of equal readings, show a device that clips what it delivers: rails
/// upright, nothing hidden on the axes beside. Two slopes known to be nil tell, a plateau counting for one; one that is
/// not nil tells the contrary.
bool are_upright(std::span<const ImuSample> samples, const RailPlanes& planes, const RailDetector::State& rails);

/// The planes of elements on whose axis no plateau of equal readings was seen.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails);

/// Brings the planes into what was classified with upright rails: an element with a plane clips where its plane says so
/// or the device does. Samples that meet a rail in a part of their window, beside one that is clipped, belong to it:
/// they lie short of the plane by less than half of what the neighbour outside still lacked.
void clip_by_planes(std::span<const ImuSample> samples, const RailPlanes& planes, std::span<Clipping> clippings);

/// Finds partial axes as mark_partial() does, with the rail of each element where its plane is known.
void mark_partial(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                  double noise_rad_s, const ImuSample* before, RateObservation& now, const ImuSample* after);

/// Doubts readings near the rails of the other elements on an element whose own rail was not seen: too few samples show
/// no plane. Such a reading counts as one that may be short by as much as it steps to its neighbours.
void doubt_unseen_rails(const RailPlanes& planes, double noise_rad_s, const ImuSample* before, RateObservation& now,
                        const ImuSample* after);

/// What the planes tell of RigConstants::elements, where that is more than `params` knew.
RigCalibration with_planes(const RateModelParams& params, const RailPlanes& planes, bool upright);

}  // namespace tumble
