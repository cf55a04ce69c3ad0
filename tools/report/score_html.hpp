// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"
#include "scenarios/summary/summary.hpp"

namespace tumble::tools {

std::string styled_value(const std::string& metric, double value_si, bool with_unit);

std::string styled_interval(const std::string& metric, const scenarios::Interval& interval);

std::string score_table_html(const scenarios::Section& section);

std::string differences_html(const std::vector<scenarios::MetricComparison>& rows);

std::string paired_failures_html(const std::vector<scenarios::FailureComparison>& rows);

}  // namespace tumble::tools
