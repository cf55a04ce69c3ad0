// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/scoring/outcome_status.hpp"
#include "scenarios/scoring/scored_estimate.hpp"

namespace tumble::scenarios {

/// One score of an outcome; the metric's name ends in its unit (docs/design.md, "Scores").
struct Score {
  std::string metric;
  double value;
};

/// Returns the score with the metric's name, or null.
const Score* find_score(std::span<const Score> scores, const std::string& metric);
/// Returns the value of the metric's score, or NaN.
double value_of(std::span<const Score> scores, const std::string& metric);

/// A metric with its description, registered in one line of the source file of its group.
struct Metric {
  MetricInfo info;
  Kind kind;
  /// Returns false if there is nothing to score (no clipped sample, no map).
  bool (*compute)(const ScoredEstimate& scored, double& value);
};

std::span<const Metric> metrics();

/// Returns the scores of all metrics that apply to a kind, in order of registration. Callers that also need the verdict
/// should pass one ScoredEstimate to both functions.
std::vector<Score> score(Kind kind, const ScoredEstimate& scored);
std::vector<Score> score(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns `ok` or `diverged`. An estimate diverged in any of these cases:
/// - the estimate is not finite;
/// - the estimate has a gap longer than a fifth of the recording (rates: more than a tenth of the samples are missing);
/// - the end error exceeds the path length (at least 1 m);
/// - the estimate reports sweeps but registered fewer than six.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);
OutcomeStatus verdict(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns true if a trajectory is finite and its end error is below the path length that the trajectory covers.
/// Compared with `verdict`, this function does not test for gaps.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
