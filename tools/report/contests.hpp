// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"
#include "scenarios/summary/summary.hpp"

namespace tumble::tools {

enum class Certainty {
  corrected,  ///< significant in the corrected test
  interval,   ///< only the BCa interval excludes 0
  open        ///< not significant by either criterion
};

struct ContestResult {
  scenarios::MetricComparison row;
  Certainty certainty = Certainty::open;
  bool better = false;  ///< may be chance if `open`
  /// Difference in percent of the reference method's median, with its interval; an end is infinite if one run of a pair
  /// failed
  double percent = 0.0, percent_low = 0.0, percent_high = 0.0;
  double times = std::numeric_limits<double>::quiet_NaN();
  /// The confidence interval alone does not decide, because the method was chosen as the best of several methods on
  /// these runs.
  bool won() const { return better && certainty == Certainty::corrected; }
  bool lost() const { return !better && certainty == Certainty::corrected; }
};

/// Attitude describes the motion least, so it is included only if there is no other kind.
std::vector<ContestResult> contests(const scenarios::Summary& summary, const scenarios::Comparison& comparison);

struct Tally {
  std::size_t contests = 0, won = 0, lost = 0, open = 0;  ///< open: neither won nor lost
  std::size_t ahead = 0;                                  ///< open, but the method is better
  std::string ahead_by;                                   ///< method ahead in all; may be empty
  std::string leader;                                     ///< method with most wins
  std::size_t leader_won = 0;                             ///< number of contests that the leader wins
};
Tally tally(const std::vector<ContestResult>& results);

std::string tally_text(const Tally& tally);

std::string certainty_text(const ContestResult& result, std::size_t comparisons);

}  // namespace tumble::tools
