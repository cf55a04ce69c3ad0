// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/same_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"

namespace tumble::scenarios {

namespace {

bool is_beyond(const Outcome& outcome, const std::string& metric, double limit) {
  const double value = value_of(outcome.scores, metric);
  if (std::isnan(value)) return false;
  return metric_info(metric).sense == Sense::higher ? value < limit : value > limit;
}

}  // namespace

SameFailure::SameFailure(const Failure& failure, const Outcome& outcome) : status_(outcome.status) {
  if (status_ == OutcomeStatus::killed)
    throw BadInput(fmt::format(
        "the operating system killed the run (status 'killed'), so the run shows nothing about the method: {}",
        outcome.message));
  if (status_ != OutcomeStatus::ok) return;
  if (!failure.metric.empty() && is_beyond(outcome, failure.metric, failure.limit)) {
    metric_ = failure.metric;
    limit_ = failure.limit;
    return;
  }
  const auto condemned = std::find_if(outcome.scores.begin(), outcome.scores.end(), is_failed_verdict);
  if (condemned != outcome.scores.end()) {
    metric_ = condemned->metric;  // metric of unit verdict: 0 passes, 1 fails
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
  return outcome.status == status_ && (metric_.empty() || is_beyond(outcome, metric_, limit_));
}

std::string SameFailure::describe() const {
  if (metric_.empty()) return to_string(status_);
  if (metric_info(metric_).unit == Unit::verdict) return metric_;
  std::ostringstream text;
  text << metric_ << " worse than " << limit_;
  return text.str();
}

}  // namespace tumble::scenarios
