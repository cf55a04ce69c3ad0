// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/scoring/outcome_status.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct ScoringInput {
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;
  const sim::Surface* surface = nullptr;
};

class ScoredEstimate {
 public:
  ScoredEstimate(const Estimate& estimate, const ScoringInput& input);

  const Estimate& estimate() const { return *estimate_; }
  const sim::Sensors& sensors() const { return *input_.sensors; }
  const sim::Truth& truth() const { return *input_.truth; }
  const sim::Surface* surface() const { return input_.surface; }

  template <typename Made>
  const Made& once(Made (*make)(const ScoredEstimate&)) const {
    const auto key = reinterpret_cast<void (*)()>(make);  // used as a key, never called
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(key, std::make_shared<const Made>(make(*this))).first;
    return *static_cast<const Made*>(found->second.get());
  }

 private:
  const Estimate* estimate_;
  ScoringInput input_;
  mutable std::map<void (*)(), std::shared_ptr<const void>> made_;  ///< by the function that computes the value
};

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

/// Returns `ok` for a usable estimate, and `diverged` in each of these cases:
/// - The estimate is not finite.
/// - The estimate has a gap longer than a fifth of the recording, or rates for less than nine tenths of the samples.
/// - The end error exceeds the path length (or 1 m for shorter paths).
/// - The estimate reports sweeps, but fewer than six sweeps are registered.
OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored);

/// Returns true if a trajectory is finite and its end error is below its path length. The function trajectory_holds()
/// does not test for gaps, unlike `verdict`.
bool trajectory_holds(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
