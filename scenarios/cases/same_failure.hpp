// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// A run without a value of the failure's metric counts as a success. For example, the rate error at clipped samples
/// has no value in a run without clipping.
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
