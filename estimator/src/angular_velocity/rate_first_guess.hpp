// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

/// Computes initial rates with a smoother and the published rate recovery (SaturationAwareRateEstimator). Clipped
/// readings are lower bounds of the rates. The samples must be valid.
std::vector<AngularRateEstimate> first_guess(std::span<const AngularRateObservation> observations,
                                             const AngularRateModelParams& model, const AngularRateModel& derived,
                                             double gap_max_s);

}  // namespace tumble
