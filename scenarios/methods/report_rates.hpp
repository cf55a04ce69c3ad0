// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "scenarios/methods/method.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

void report_rates(const RegimeSmoother::Report& report, Estimate& result);

std::optional<double> carried_share(const RegimeSmoother::Report& report);

void report_gaps(std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
