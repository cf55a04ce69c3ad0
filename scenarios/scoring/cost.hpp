// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

/// Returns the description of the CPU time of an estimate. The results database stores the CPU time like a metric.
const MetricInfo& estimate_cost();

/// Returns whether a score is a computing cost. Computing costs differ between identical runs.
bool is_cost(std::string_view name);

}  // namespace tumble::scenarios
