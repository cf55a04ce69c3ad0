// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/statistics/confidence_sequence.hpp"
#include "scenarios/summary/selection.hpp"

namespace tumble::scenarios {

namespace {

std::string kind_of(const std::string& name) {
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash);
}

void require_contest(const std::string& metric, const std::string& kind) {
  const MetricInfo& info = metric_info(metric);
  const auto all = metrics();
  const auto own = std::find_if(all.begin(), all.end(), [&](const Metric& m) { return m.info.name == info.name; });
  if (own == all.end() || info.sense == Sense::none)
    throw BadInput(
        fmt::format("--until: the metric '{}' is unknown or cannot rank methods; choose a metric for which lower or "
                    "higher values are better",
                    metric));
  if (to_string(own->kind) != kind)
    throw BadInput(fmt::format("metric '{}' is of kind '{}'; it must be of kind '{}', like the methods", metric,
                               to_string(own->kind), kind));
}

struct AnswerPair {
  std::optional<double> own, other;
};
using AnswerPairs = std::map<std::string, std::map<std::uint64_t, AnswerPair>, std::less<>>;

std::optional<double> value_of(const OutcomeView& row, const Question& question) {
  if (row.status != OutcomeStatus::ok) return worst_value(metric_info(question.metric));
  for (const OutcomeView::Value& score : row.scores) {
    if (*score.metric == question.metric) return score.value;
  }
  return std::nullopt;
}

AnswerPairs pairs_of(const Results& results, const Question& question, std::uint64_t last_seed) {
  AnswerPairs pairs;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (row.seed < question.first_seed || row.seed > last_seed) return;
    const std::string method(row.method);
    const bool own = is_named(question.method, row.kind, method);
    if (!own && !is_named(question.against, row.kind, method)) return;
    AnswerPair& pair = pairs[std::string(row.scenario)][row.seed];
    (own ? pair.own : pair.other) = value_of(row, question);
  });
  return pairs;
}

Answer answer_of(const std::string& scenario, const std::map<std::uint64_t, AnswerPair>& pairs,
                 const Question& question, std::uint64_t last_seed) {
  const double risk = question.risk / static_cast<double>(question.scenarios.size());
  const MetricInfo& info = metric_info(question.metric);
  const Margin wanted{-question.margin.value, question.margin.relative};
  Answer answer{scenario};
  answer.seeds = last_seed - question.first_seed + 1;
  answer.better_share = probability_at_any_time(0, 0, risk);
  for (const auto& [seed, pair] : pairs) {
    if (!pair.own || !pair.other) continue;
    const double difference = worse_by(info, *pair.own, *pair.other, wanted);
    if (difference == 0.0) continue;
    (difference < 0.0 ? answer.better : answer.worse) += 1;
    answer.better_share = probability_at_any_time(answer.better, answer.worse, risk);
    if (answer.better_share.low <= 0.5 && answer.better_share.high >= 0.5) continue;
    answer.finding = answer.better_share.low > 0.5 ? Finding::better : Finding::worse;
    answer.seeds = seed - question.first_seed + 1;
    break;
  }
  return answer;
}

}  // namespace

std::string Question::describe() const {
  std::string scenes;
  for (const std::string& scenario : scenarios) scenes += (scenes.empty() ? "" : ",") + scenario;
  return fmt::format("{}:{}:{}:{:.17g}{} of scenarios {}, seeds from {}, risk of a wrong answer {:.17g}", method,
                     against, metric, margin.relative ? 100.0 * margin.value : margin.value, margin.relative ? "%" : "",
                     scenes, first_seed, risk);
}

void require_sound(const Question& question) {
  const std::string kind = kind_of(question.method);
  for (const std::string& name : {question.method, question.against}) {
    if (kind_of(name).empty())
      throw BadInput(fmt::format(
          "method '{}' of the question (--until) must be written with its kind, for example 'rate/tumble'", name));
    if (kind_of(name) != kind)
      throw BadInput(
          fmt::format("methods '{}' and '{}' have different kinds, so no metric can compare these methods; choose "
                      "methods of one kind",
                      question.method, name));
  }
  if (question.method == question.against)
    throw BadInput(fmt::format("method '{}' is compared with itself; name two different methods", question.method));
  require_contest(question.metric, kind);
  if (!(question.margin.value >= 0.0 && std::isfinite(question.margin.value)))
    throw BadInput(fmt::format("the margin of the question (--until) is {}; it must be finite and at least 0",
                               std::to_string(question.margin.value)));
  if (!(question.risk > 0.0 && question.risk < 1.0))
    throw BadInput(fmt::format("the risk of a wrong answer to the question (--until) is {}; it must be within (0, 1)",
                               std::to_string(question.risk)));
  if (question.scenarios.empty()) throw BadInput("the comparison of two methods (--until) needs at least one scenario");
}

void claim(Results& results, const Question& question, const std::filesystem::path& database) {
  const std::string known = results.note(kQuestionNote), asked = question.describe();
  if (known == asked) return;
  if (!known.empty())
    throw BadInput(
        fmt::format("{}: this database belongs to a sweep with the --until question '{}', but this sweep has the "
                    "question '{}'; choose another file",
                    database.string(), known, asked));
  if (!results.outcomes().empty())
    throw BadInput(
        fmt::format("{}: this database contains simulated runs of a sweep without --until; choose another file",
                    database.string()));
  results.set_note(kQuestionNote, asked);
}

std::vector<Answer> answers(const Results& results, const Question& question, std::uint64_t last_seed) {
  require_sound(question);
  const AnswerPairs pairs = pairs_of(results, question, last_seed);
  std::vector<Answer> out;
  for (const std::string& scenario : question.scenarios) {
    const auto found = pairs.find(scenario);
    out.push_back(answer_of(scenario, found == pairs.end() ? std::map<std::uint64_t, AnswerPair>() : found->second,
                            question, last_seed));
  }
  return out;
}

const char* finding_text(const Answer& answer, const Question& question) {
  return answer.finding == Finding::worse && question.margin.value > 0.0 ? "not better by more than the margin"
                                                                         : to_string(answer.finding);
}

bool all_answered(const std::vector<Answer>& answers) {
  return std::all_of(answers.begin(), answers.end(),
                     [](const Answer& each) { return each.finding != Finding::undecided; });
}

}  // namespace tumble::scenarios
