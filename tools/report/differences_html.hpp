// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"

namespace tumble::tools {

/// A folded table per section: every method beside the baseline, pair by pair.
std::string differences_html(const std::vector<scenarios::MetricComparison>& rows);

/// The same of failures and verdicts; sections in which nothing failed are named in one sentence.
std::string paired_failures_html(const std::vector<scenarios::FailureComparison>& rows);

}  // namespace tumble::tools
