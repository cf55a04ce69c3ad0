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

/// Score is the value of one metric for one outcome; the metric's name ends in its unit (docs/design.md, "Methods and
/// scores").
struct Score {
  std::string metric;
  double value;
};

/// Returns the score of the metric with this name, or null.
const Score* find_score(std::span<const Score> scores, const std::string& metric);
/// Returns the value of the metric with this name, or NaN.
double value_of(std::span<const Score> scores, const std::string& metric);

/// Metric is a registered metric: its description and the function that computes it. Each metric has one line in the
/// source file of its group.
struct Metric {
  MetricInfo info;
  Kind kind;
  /// Computes `value`; returns false if there is nothing to score, for example no clipped sample or no map.
  bool (*compute)(const ScoredEstimate& scored, double& value);
};

std::span<const Metric> metrics();

/// Computes the scores of all metrics that apply to a kind of method, in order of registration. For efficiency, a
/// caller should pass the same ScoredEstimate to `score` and `verdict`.
std::vector<Score> score(Kind kind, const ScoredEstimate& scored);
std::vector<Score> score(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns whether an estimate is usable: `ok` or `diverged`. An estimate counts as `diverged` in any of the following
/// cases.
/// - The estimate is not finite.
/// - The estimate has a gap longer than a fifth of the recording, or rates for less than nine tenths of the samples.
/// - The end error exceeds the path length (or 1 m for shorter paths).
/// - The estimate reports sweeps but registered fewer than six sweeps.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);
OutcomeStatus verdict(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns whether a trajectory is finite and its end error is below the length of its path. Unlike `verdict`, this
/// function does not test for gaps.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
