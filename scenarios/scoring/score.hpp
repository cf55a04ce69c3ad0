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

/// Score is one score of an outcome; the metric's name ends in its unit (docs/design.md, "Methods and scores").
struct Score {
  std::string metric;
  double value;
};

/// Returns the score of the metric with this name, or null.
const Score* find_score(std::span<const Score> scores, const std::string& metric);
/// Returns the value of the metric's score, or NaN.
double value_of(std::span<const Score> scores, const std::string& metric);

/// Metric is a metric with its description. Each metric is registered by one line in the source file of its group.
struct Metric {
  MetricInfo info;
  Kind kind;
  /// Computes `value`; returns false if there is nothing to score (no clipped sample, no map).
  bool (*compute)(const ScoredEstimate& scored, double& value);
};

std::span<const Metric> metrics();

/// Returns the scores of all metrics that apply to a kind, in order of registration. A caller that also needs the
/// verdict should pass the ScoredEstimate of the scores to `verdict`.
std::vector<Score> score(Kind kind, const ScoredEstimate& scored);
std::vector<Score> score(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns `ok` or `diverged`. An estimate counts as diverged in any of the following cases.
/// - The estimate is not finite.
/// - The estimate has a gap longer than a fifth of the recording, or rates for less than nine tenths of the samples.
/// - The end error exceeds the path length (at least 1 m).
/// - The estimate reports sweeps but registered fewer than six sweeps.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);
OutcomeStatus verdict(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns true if a trajectory is finite and its end error is below the length of its path. Unlike `verdict`, this
/// function does not test for gaps.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
