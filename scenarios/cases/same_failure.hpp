// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// How an outcome failed, so that a simpler draw which fails for another reason is told from it: by its status; else by
/// the metric that was asked for; else by a verdict (`map_failed`). Unlike Failure, a run without the metric does not
/// fail by it: a draw in which nothing clips has no error of clipped samples.
class SameFailure {
 public:
  /// Throws BadInput when `outcome` does not fail, or was `killed`.
  SameFailure(const Failure& failure, const Outcome& outcome);

  bool holds(const Outcome& outcome) const;
  /// "diverged", "map_failed", "translation_error_end_m beyond 0.5".
  std::string describe() const;
  /// The metric that tells it; empty where the status does.
  const std::string& metric() const { return metric_; }

 private:
  OutcomeStatus status_;
  std::string metric_;
  double limit_ = 0.0;
};

}  // namespace tumble::scenarios
