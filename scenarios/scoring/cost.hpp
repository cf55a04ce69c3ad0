// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

/// What an estimate costs: its CPU time, as sweeps store it.
const MetricInfo& estimate_cost();

/// Whether a score is what a run cost the machine, which no two runs have alike, and says nothing of the answer.
bool is_cost(std::string_view name);

}  // namespace tumble::scenarios
