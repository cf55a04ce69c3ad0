// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

/// What an estimate costs: its CPU time, as sweeps store it.
const MetricInfo& estimate_cost();

}  // namespace tumble::scenarios
