// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/summary/question.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/session.hpp"

/// What is asked of two methods, as words of the command line. All throw scenarios::BadInput with one clear line.
namespace tumble::tools {

/// "0.05", in the metric's unit, or "10%", of the other's value; `option` begins the message.
scenarios::Margin parse_margin(const std::string& option, const std::string& text);

/// "A:B:METRIC" or "A:B:METRIC:MARGIN", of the scenarios and seeds of a suite whose methods A and B are.
scenarios::Question parse_question(const std::string& text, double risk, const scenarios::Suite& suite);

/// A line a scenario.
Table table_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);
nlohmann::json json_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);

}  // namespace tumble::tools
