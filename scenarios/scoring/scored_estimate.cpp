// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/scored_estimate.hpp"

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

ScoredEstimate::ScoredEstimate(const Estimate& estimate, const ScoringInput& input)
    : estimate_(&estimate), input_(input) {
  if (input.sensors == nullptr || input.truth == nullptr) throw BadInput("scoring needs both sensor data and truth");
}

}  // namespace tumble::scenarios
