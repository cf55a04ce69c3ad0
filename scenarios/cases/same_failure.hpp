// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

/// A run for which the failure's metric has no value counts as a success, for example a run without clipping for an
/// error at clipped samples.
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
