// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"

namespace tumble::tools {

std::string differences_html(const std::vector<scenarios::MetricComparison>& rows);

std::string paired_failures_html(const std::vector<scenarios::FailureComparison>& rows);

}  // namespace tumble::tools
