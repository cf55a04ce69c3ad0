// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"

namespace tumble::tools {

/// Returns one folded table per section with the paired differences between each method and the baseline.
std::string differences_html(const std::vector<scenarios::MetricComparison>& rows);

/// Returns the folded tables of failures and pass-fail metrics. One sentence lists the sections without failures.
std::string paired_failures_html(const std::vector<scenarios::FailureComparison>& rows);

}  // namespace tumble::tools
