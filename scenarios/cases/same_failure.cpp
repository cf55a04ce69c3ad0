// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/same_failure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

SameFailure::SameFailure(const FailureGoal& failure, const Outcome& outcome) : status_(outcome.status) {
  if (status_ == OutcomeStatus::killed)
    throw BadInput(fmt::format(
        "the operating system killed the run (status 'killed'), so the run shows nothing about the method: {}",
        outcome.message));
  if (status_ != OutcomeStatus::ok) return;
  if (!failure.metric.empty() && failure.is_worse(value_of(outcome.scores, failure.metric))) {
    goal_ = failure;
    return;
  }
  const auto condemned = std::find_if(outcome.scores.begin(), outcome.scores.end(), is_failed_verdict);
  if (condemned != outcome.scores.end()) {
    goal_.metric = condemned->metric;  // metric of unit verdict: 0 passes, 1 fails
    return;
  }
  const std::string text = "the run does not fail: its status is 'ok', and no pass-fail metric has failed";
  if (failure.metric.empty()) throw BadInput(text);
  const Score* const score = find_score(outcome.scores, failure.metric);
  if (score == nullptr)
    throw BadInput(fmt::format("{}; metric {} is missing in the scores of the run", text, failure.metric));
  throw BadInput(fmt::format("{}; metric {} is {:g}, which is not worse than the limit {:g}", text, failure.metric,
                             score->value, failure.limit));
}

bool SameFailure::holds(const Outcome& outcome) const {
  return outcome.status == status_ && (metric().empty() || goal_.is_worse(value_of(outcome.scores, metric())));
}

std::string SameFailure::describe() const {
  if (metric().empty()) return to_string(status_);
  return metric_info(metric()).unit == Unit::verdict ? metric() : goal_.text();
}

}  // namespace tumble::scenarios
