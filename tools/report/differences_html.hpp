// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"

namespace tumble::tools {

/// Returns one folded table per section with the paired difference of each method to the baseline.
std::string differences_html(const std::vector<scenarios::MetricComparison>& rows);

/// Returns the folded tables for failures and pass-fail metrics. Sections without failures are listed in one sentence.
std::string paired_failures_html(const std::vector<scenarios::FailureComparison>& rows);

}  // namespace tumble::tools
