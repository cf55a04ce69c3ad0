// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/failure_goal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kWorstScore = std::numeric_limits<double>::infinity();

bool is_higher_better(const std::string& metric) {
  return metric_info(metric).sense == Sense::higher;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

void require_metric(const std::string& name, Kind kind) {
  std::vector<std::string> known;
  for (const Metric& metric : metrics()) {
    if (metric.kind == kind) known.push_back(metric.info.name);
  }
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw BadInput(fmt::format("unknown metric '{}' of kind {}{}", name, to_string(kind), suggestion(name, known)));
}

}  // namespace

bool is_failed_verdict(const Score& score) {
  return metric_info(score.metric).marks_failure() && score.value != 0.0;
}

bool FailureGoal::holds(const Outcome& outcome) const {
  if (!metric.empty() && metric_info(metric).excuses_reported_runs) {
    const Score* score = find_score(outcome.scores, metric);
    return score == nullptr || this->score(outcome.status, score->value) > bound();
  }
  if (outcome.status != OutcomeStatus::ok) return true;
  if (std::any_of(outcome.scores.begin(), outcome.scores.end(), is_failed_verdict)) return true;
  if (metric.empty()) return false;
  const Score* score = find_score(outcome.scores, metric);
  return score == nullptr || std::isnan(score->value) || is_worse(score->value);
}

bool FailureGoal::is_worse(double value) const {
  return value_at(value) > value_at(limit);
}

double FailureGoal::score(OutcomeStatus status, double value) const {
  if (status == OutcomeStatus::rejected) return -kWorstScore;
  const bool reported = status == OutcomeStatus::diverged && metric_info(metric).excuses_reported_runs;
  if (status != OutcomeStatus::ok && !reported) return kWorstScore;
  if (std::isnan(value)) return -kWorstScore;
  return value_at(value);
}

double FailureGoal::value_at(double score) const {
  return is_higher_better(metric) ? -score : score;
}

double FailureGoal::bound() const {
  const double largest = std::numeric_limits<double>::max();
  return std::clamp(value_at(limit), -largest, largest);
}

std::string FailureGoal::text() const {
  return fmt::format("{} {} {}", metric, is_higher_better(metric) ? '<' : '>', limit);
}

FailureGoal parse_goal(const std::string& text, Kind kind) {
  const std::size_t sign = text.find_first_of("<>");
  FailureGoal goal;
  if (sign == std::string::npos || trimmed(text.substr(0, sign)).empty() ||
      !read_number(trimmed(text.substr(sign + 1)), goal.limit) || std::isnan(goal.limit))
    throw BadInput(
        fmt::format("--failure is '{}'; write 'METRIC > VALUE' with a number in SI units. 'METRIC > inf' counts only "
                    "runs with a status other than ok",
                    shortened(text)));
  goal.metric = trimmed(text.substr(0, sign));
  require_metric(goal.metric, kind);
  const char worse = is_higher_better(goal.metric) ? '<' : '>';
  if (text[sign] != worse)
    throw BadInput(fmt::format("--failure is '{}'; write '{} {} {}', because {} values of this metric are worse", text,
                               goal.metric, worse, goal.limit, worse == '<' ? "lower" : "higher"));
  return goal;
}

}  // namespace tumble::scenarios
