// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

namespace tumble::tools {

/// Formats a value in the metric's display unit with three significant digits, for example "0.42 rad/s".
std::string styled_value(const std::string& metric, double value_si, bool with_unit);

/// Formats an interval, for example "0.42 [0.31, 0.60]"; the bracket is "[-]" if there are too few runs.
std::string styled_interval(const std::string& metric, const scenarios::Interval& interval);

/// Returns the table of one section: one row per metric, one column per method with median, interval and paired wins.
/// The first row shows the failures.
std::string score_table_html(const scenarios::Section& section);

}  // namespace tumble::tools
