// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// SameFailure describes how an outcome failed: by its status, by the metric that the caller chose, or by a pass-fail
/// metric (`map_failed`). A run without the metric passes, for example because a run without clipping has no error at
/// clipped samples.
class SameFailure {
 public:
  SameFailure(const Failure& failure, const Outcome& outcome);

  bool holds(const Outcome& outcome) const;
  std::string describe() const;
  const std::string& metric() const { return metric_; }

 private:
  OutcomeStatus status_;
  std::string metric_;
  double limit_ = 0.0;
};

}  // namespace tumble::scenarios
