// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"
#include "scenarios/summary/summary.hpp"

/// What a report says first: of each section of the results who does best, by how much, and how sure that is.
namespace tumble::tools {

/// How much of a difference the draws show.
enum class Certainty {
  corrected,  ///< the signed-rank test tells the two apart, corrected for all comparisons of the page
  interval,   ///< the difference's own BCa interval leaves 0 out, the corrected test does not tell them apart
  open        ///< neither
};

/// One section: its best method that needs no truth and is not the baseline, paired with the baseline by the first
/// headline metric that both have.
struct ContestResult {
  scenarios::MetricComparison row;
  Certainty certainty = Certainty::open;
  bool better = false;  ///< the difference is on the better side; where `open` it may be chance
  /// The difference over the size of the baseline's median, with its interval [%]; NaN where the median is 0 or not
  /// finite, or the difference is not. A bound may be infinite: of pairs of which one run failed.
  double percent = 0.0, percent_low = 0.0, percent_high = 0.0;
  /// Of a metric where less is better the baseline's median over the method's; NaN where there is none.
  double times = std::numeric_limits<double>::quiet_NaN();
  /// The interval alone decides nothing: it is that of the best of several methods, chosen by the same draws.
  bool won() const { return better && certainty == Certainty::corrected; }
  bool lost() const { return !better && certainty == Certainty::corrected; }
};

/// In the order of the summary's sections. Attitude, which says least about the motion, only where there is nothing
/// else; a section that has the baseline alone has no contest.
std::vector<ContestResult> contests(const scenarios::Summary& summary, const scenarios::Comparison& comparison);

/// How the contests ended.
struct Tally {
  std::size_t contests = 0, won = 0, lost = 0, open = 0;  ///< open: neither won nor lost
  std::size_t ahead = 0;       ///< of the open ones: better by their own interval alone, or on every draw
  std::string ahead_by;        ///< the one method that is ahead in all of these; "": several are, or none
  std::string leader;          ///< the method that wins most of them, the first of equals; "": none is won
  std::size_t leader_won = 0;  ///< by it
};
Tally tally(const std::vector<ContestResult>& results);

/// "tumble is better than the baseline in 3 of 4 contests": one sentence that is true of the tally.
std::string tally_text(const Tally& tally);

/// What `certainty` says of a contest, in words: which way, and what it takes where it is open.
std::string certainty_text(const ContestResult& result, std::size_t comparisons);

}  // namespace tumble::tools
