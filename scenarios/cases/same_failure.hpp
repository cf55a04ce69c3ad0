// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// How an outcome failed: by status, else by the requested metric, else by a verdict (`map_failed`). Distinguishes
/// simpler draws that fail for another reason. Unlike with Failure, a run without the metric does not fail by it: a
/// draw without clipping has no error at clipped samples.
class SameFailure {
 public:
  /// Throws BadInput if `outcome` does not fail, or was `killed`.
  SameFailure(const Failure& failure, const Outcome& outcome);

  bool holds(const Outcome& outcome) const;
  /// Returns "diverged", "map_failed", "translation_error_end_m beyond 0.5".
  std::string describe() const;
  /// Returns the metric of the failure; empty if it is the status.
  const std::string& metric() const { return metric_; }

 private:
  OutcomeStatus status_;
  std::string metric_;
  double limit_ = 0.0;
};

}  // namespace tumble::scenarios
