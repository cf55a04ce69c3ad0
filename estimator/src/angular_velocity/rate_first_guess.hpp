// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

/// Computes initial rates with a smoother and the published rate recovery (Saave). Clipped readings are lower bounds of
/// the rates. The samples must be valid.
std::vector<RateEstimate> first_guess(std::span<const RateObservation> observations, const RateModelParams& model,
                                      const RateModel& derived, double gap_max_s);

}  // namespace tumble
