// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

namespace tumble::tools {

std::string styled_value(const std::string& metric, double value_si, bool with_unit);

std::string styled_interval(const std::string& metric, const scenarios::Interval& interval);

std::string score_table_html(const scenarios::Section& section);

}  // namespace tumble::tools
