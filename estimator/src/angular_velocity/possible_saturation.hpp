// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

/// If the saturation level of a sensing element is unknown, readings near the saturation levels of the other elements
/// are marked as possibly saturated. Readings below `least`, the smallest possible saturation level, remain unmarked.
void inflate_covariance_near_limits(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                                    const ImuSample* after);

/// Marks successive, almost equal maximum readings that may hide a saturated peak. No reading is marked if the device
/// flags clipping, or if no saturation level is known.
void inflate_covariance_at_plateaus(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double offset_sigma_ratio, double noise_rad_s,
                                    std::span<AngularRateObservation> observations);

}  // namespace tumble
