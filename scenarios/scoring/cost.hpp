// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

/// Returns the description of an estimate's CPU time, which the results database stores like a metric.
const MetricInfo& estimate_cost();

/// Returns true if a score is a computing cost. Computing costs differ between identical runs.
bool is_cost(std::string_view name);

}  // namespace tumble::scenarios
