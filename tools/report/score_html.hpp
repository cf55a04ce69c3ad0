// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

namespace tumble::tools {

/// "0.42 rad/s": a metric's value in the unit of its style, three significant digits.
std::string styled_value(const std::string& metric, double value_si, bool with_unit);

/// "0.42 [0.31, 0.60]"; "[-]" for an interval that too few draws leave open.
std::string styled_interval(const std::string& metric, const scenarios::Interval& interval);

/// The table of one section: a row per metric, a column per method with median, interval and paired wins; failures
/// first.
std::string score_table_html(const scenarios::Section& section);

}  // namespace tumble::tools
