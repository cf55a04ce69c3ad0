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

/// One number of an outcome; the metric's name ends in its unit (docs/design.md, "Scores").
struct Score {
  std::string metric;
  double value;
};

/// That of a metric; null where there is none.
const Score* find_score(std::span<const Score> scores, const std::string& metric);
/// Its value; NaN where there is none.
double value_of(std::span<const Score> scores, const std::string& metric);

/// A metric, self-describing; one line of registration each, in its family's file.
struct Metric {
  MetricInfo info;
  Kind kind;
  /// False when the estimate or recording has nothing to score (no clipped sample, no map).
  bool (*compute)(const ScoredEstimate& scored, double& value);
};

std::span<const Metric> metrics();

/// All metrics of a kind that apply, in order of registration. Who asks for the verdict too makes one ScoredEstimate
/// for both.
std::vector<Score> score(Kind kind, const ScoredEstimate& scored);
std::vector<Score> score(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// `ok`, or `diverged`: an estimate that is not finite, that leaves more than a fifth of the recording in one piece
/// (rates: more than a tenth of the samples) unanswered, that ends farther from the truth than the path is long (1 m at
/// least), or that reports sweeps and registers fewer than six.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);
OutcomeStatus verdict(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Whether a trajectory is finite and ends nearer to the truth than the path is long, over the segment that it answers,
/// however short that is: what `verdict` asks of poses but for the holes.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
