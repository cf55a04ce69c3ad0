// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/asked.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/text.hpp"
#include "tools/tumble/arguments.hpp"

namespace tumble::tools {

using scenarios::BadInput;
using scenarios::Question;

scenarios::Margin parse_margin(const std::string& option, const std::string& text) {
  const bool relative = text.ends_with('%');
  double value = 0.0;
  const std::string_view number = std::string_view(text).substr(0, text.size() - (relative ? 1 : 0));
  if (!scenarios::read_number(number, value) || !std::isfinite(value) || value < 0.0)
    throw BadInput(
        fmt::format("{} is '{}'; write a number of at least 0, with or without %, for example 10%", option, text));
  return {relative ? value / 100.0 : value, relative};
}

Question parse_question(const std::string& text, double risk, const scenarios::Suite& suite) {
  std::vector<std::string> words;
  std::stringstream stream(text + ":");  // keeps a trailing empty word
  for (std::string word; std::getline(stream, word, ':');) words.push_back(word);
  if (words.size() < 3 || words.size() > 4 || std::find(words.begin(), words.end(), "") != words.end())
    throw BadInput(
        fmt::format("--until is '{}'; write A:B:METRIC or A:B:METRIC:MARGIN, for example rate/tumble:rate/raw:{}:10%",
                    text, scenarios::headline_metrics(scenarios::Kind::rate).front()));
  std::vector<std::string> known;
  for (const scenarios::MethodPointer& method : scenarios::find_methods(suite.methods))
    known.push_back(full_name(method->info));
  for (const std::string& name : {words[0], words[1]}) require_known("method of the suite", name, known);
  Question question;
  question.method = words[0];
  question.against = words[1];
  question.metric = words[2];
  if (words.size() == 4) question.margin = parse_margin("the margin of --until", words[3]);
  question.risk = risk;
  question.first_seed = suite.first_seed;
  question.scenarios = suite.scenarios;
  require_sound(question);
  return question;
}

Table table_of(const std::vector<scenarios::Answer>& answers, const Question& question) {
  Table table(
      fmt::format(
          "Is {} better than {} in {}{}? If neither method is better, the probability of a wrong answer is at most "
          "{:g}",
          question.method, question.against, question.metric,
          question.margin.value == 0.0 ? ""
          : question.margin.relative   ? fmt::format(" by {:g} %", 100.0 * question.margin.value)
                                       : fmt::format(" by {:g}", question.margin.value),
          question.risk),
      {"scenario", "answer", "seeds used",
       question.margin.value > 0.0 ? "runs won by more than the margin : other runs" : "better : worse",
       "share better, interval"});
  table.align_right_from(2);
  for (const scenarios::Answer& each : answers) {
    table.add_row({each.scenario, finding_text(each, question), std::to_string(each.seeds),
                   fmt::format("{} : {}", each.better, each.worse),
                   fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100.0 * each.better_share.value,
                               100.0 * each.better_share.low, 100.0 * each.better_share.high)});
  }
  return table;
}

nlohmann::json json_of(const std::vector<scenarios::Answer>& answers, const Question& question) {
  nlohmann::json rows = nlohmann::json::array();
  for (const scenarios::Answer& each : answers) {
    rows.push_back({{"scenario", each.scenario},
                    {"finding", finding_text(each, question)},
                    {"seeds", each.seeds},
                    {"better", each.better},
                    {"worse", each.worse},
                    {"better_share", each.better_share.value},
                    {"better_share_low", each.better_share.low},
                    {"better_share_high", each.better_share.high}});
  }
  return {{"question", question.describe()}, {"answers", std::move(rows)}};
}

}  // namespace tumble::tools
