// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/summary/question.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// A margin is "0.05" in the metric's unit, or "10%" of the other method's value.
scenarios::Margin parse_margin(const std::string& option, const std::string& text);

/// The question "A:B:METRIC" or "A:B:METRIC:MARGIN" asks whether method A is better than method B, over all scenarios
/// and seeds of the suite.
scenarios::Question parse_question(const std::string& text, double risk, const scenarios::Suite& suite);

Table table_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);
nlohmann::json json_of(const std::vector<scenarios::Answer>& answers, const scenarios::Question& question);

}  // namespace tumble::tools
