// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Finds readings that may have been saturated for a part of their averaging window, see rails.md (R76). Cost: O(N).
std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples,
                                                      const SaturationPlanes& planes);

/// `before` and `after` are the readings immediately before and after `now`. At the start or end of a recording, the
/// missing reading is null.
std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const SaturationPlanes& planes);

}  // namespace tumble
