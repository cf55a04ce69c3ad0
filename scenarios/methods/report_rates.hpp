// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "scenarios/methods/method.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

/// Adds the report of the rate estimation to the health of `result`, and its failed checks to the findings.
void report_rates(const RegimeSmoother::Report& report, Estimate& result);

/// Returns the fraction of hand-held samples; empty if it was not estimated.
std::optional<double> carried_share(const RegimeSmoother::Report& report);

/// If the samples have gaps (kGapMaxS), adds their number to the health.
void report_gaps(std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
