// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// SameFailure describes how an outcome failed: by its status, by the requested metric, or by a verdict (`map_failed`).
/// The search for a simpler run (shrink.hpp) thus rejects runs that fail for another reason. A run without the metric
/// counts as passed, because a run without clipping has no error at clipped samples. The struct Failure
/// (sweep/triage.hpp) in contrast counts a run without the metric as failed.
class SameFailure {
 public:
  /// Throws BadInput if `outcome` does not fail, or if its status is `killed`.
  SameFailure(const Failure& failure, const Outcome& outcome);

  bool holds(const Outcome& outcome) const;
  /// Returns a description of the failure such as "diverged", "map_failed" or "translation_error_end_m beyond 0.5".
  std::string describe() const;
  /// Returns the metric of the failure, or an empty text if the status is the failure.
  const std::string& metric() const { return metric_; }

 private:
  OutcomeStatus status_;
  std::string metric_;
  double limit_ = 0.0;
};

}  // namespace tumble::scenarios
