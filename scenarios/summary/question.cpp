// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/statistics/sequential.hpp"
#include "scenarios/summary/selection.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kLooksMax = 1000;

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
        fmt::format("metric '{}' of a question is unknown or cannot rank methods; choose a metric for which lower or "
                    "higher is better",
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
  SequentialSignTest test(question.risk / static_cast<double>(question.scenarios.size()));
  const MetricInfo& info = metric_info(question.metric);
  const Margin wanted{-question.margin.value, question.margin.relative};
  const auto all = static_cast<double>(question.last_seed - question.first_seed) + 1.0;
  Answer answer{scenario};
  auto next = pairs.begin();
  for (const std::uint64_t seed : question.look_seeds()) {
    if (seed > last_seed || test.verdict() != SequentialSignTest::Verdict::open) break;
    for (; next != pairs.end() && next->first <= seed; ++next) {
      if (!next->second.own || !next->second.other) continue;
      const double difference = worse_by(info, *next->second.own, *next->second.other, wanted);
      answer.better += difference < 0.0;
      answer.worse += difference > 0.0;
    }
    answer.seeds = seed - question.first_seed + 1;
    test.look(static_cast<double>(answer.seeds) / all, answer.better, answer.worse);
    answer.needed = test.needed();
  }
  if (test.verdict() == SequentialSignTest::Verdict::negative) answer.finding = Finding::better;
  if (test.verdict() == SequentialSignTest::Verdict::positive) answer.finding = Finding::worse;
  return answer;
}

}  // namespace

std::vector<std::uint64_t> Question::look_seeds() const {
  const std::uint64_t seeds = last_seed - first_seed + 1;
  std::vector<std::uint64_t> out;
  for (int k = 1; k <= looks; ++k) {
    const auto upto = static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(seeds) * static_cast<double>(k) / static_cast<double>(looks)));
    const std::uint64_t seed = first_seed + std::min(std::max<std::uint64_t>(upto, 1), seeds) - 1;
    if (out.empty() || seed > out.back()) out.push_back(seed);
  }
  return out;
}

std::string Question::describe() const {
  std::string scenes;
  for (const std::string& scenario : scenarios) scenes += (scenes.empty() ? "" : ",") + scenario;
  return fmt::format(
      "{}:{}:{}:{:.17g}{} of scenarios {}, seeds {}..{}, {} interim analyses, risk of a wrong answer {:.17g}", method,
      against, metric, margin.relative ? 100.0 * margin.value : margin.value, margin.relative ? "%" : "", scenes,
      first_seed, last_seed, looks, risk);
}

void require_sound(const Question& question) {
  const std::string kind = kind_of(question.method);
  for (const std::string& name : {question.method, question.against}) {
    if (kind_of(name).empty())
      throw BadInput(fmt::format(
          "method '{}' of the question (--until) must be written with its kind, for example 'rate/tumble'", name));
    if (kind_of(name) != kind)
      throw BadInput(fmt::format(
          "methods '{}' and '{}' have different kinds, so no metric can compare them; choose methods of one kind",
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
  if (question.looks < 1 || question.looks > kLooksMax)
    throw BadInput(
        fmt::format("the number of interim analyses is {}; it must be within [1, {}]", question.looks, kLooksMax));
  if (question.scenarios.empty()) throw BadInput("the comparison of two methods (--until) needs at least one scenario");
  if (question.last_seed < question.first_seed)
    throw BadInput("the comparison of two methods (--until) needs at least one seed");
}

void claim(Results& results, const Question& question, const std::filesystem::path& database) {
  const std::string known = results.note(kQuestionNote), asked = question.describe();
  if (known == asked) return;
  if (!known.empty())
    throw BadInput(
        fmt::format("{}: this file belongs to the question '{}', but the question of this run is '{}'; choose another "
                    "file",
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
  return answer.finding == Finding::worse && question.margin.value > 0.0 ? "not better by the margin of --until"
                                                                         : to_string(answer.finding);
}

bool all_answered(const std::vector<Answer>& answers) {
  return std::all_of(answers.begin(), answers.end(),
                     [](const Answer& each) { return each.finding != Finding::undecided; });
}

}  // namespace tumble::scenarios
