// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/summary/question.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/session.hpp"

/// asked.hpp parses questions about two methods ("is A better than B?") from the command line. All functions throw
/// scenarios::BadInput with a one-line message.
namespace tumble::tools {

/// Parses a margin: "0.05" in the metric's unit, or "10%" of the other method's value. Error messages start with
/// `option`.
scenarios::Margin parse_margin(const std::string& option, const std::string& text);

/// Parses a question, "A:B:METRIC" or "A:B:METRIC:MARGIN": is method A better than method B? The question covers all
/// scenarios and seeds of the suite.
scenarios::Question parse_question(const std::string& text, double risk, const scenarios::Suite& suite);

/// Returns a table of the answers, with one row per scenario.
Table table_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);
nlohmann::json json_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);

}  // namespace tumble::tools
