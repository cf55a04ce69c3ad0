// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

const MetricInfo& estimate_cost();

bool is_cost(std::string_view name);

}  // namespace tumble::scenarios
