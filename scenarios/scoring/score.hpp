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

struct Score {
  std::string metric;
  double value;
};

const Score* find_score(std::span<const Score> scores, const std::string& metric);
double value_of(std::span<const Score> scores, const std::string& metric);

struct Metric {
  MetricInfo info;
  Kind kind;
  bool (*compute)(const ScoredEstimate& scored, double& value);
};

std::span<const Metric> metrics();

std::vector<Score> score(Kind kind, const ScoredEstimate& scored);
std::vector<Score> score(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns `ok` for a usable estimate, and `diverged` in each of these cases:
/// - The estimate is not finite.
/// - The estimate has a gap longer than a fifth of the recording, or rates for less than nine tenths of the samples.
/// - The end error exceeds the path length (or 1 m for shorter paths).
/// - The estimate reports sweeps, but fewer than six sweeps are registered.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);
OutcomeStatus verdict(Kind kind, const Estimate& estimate, const ScoringInput& input);

/// Returns true if a trajectory is finite and its end error is below its path length; unlike `verdict`, gaps are not
/// tested.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
