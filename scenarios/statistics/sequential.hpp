// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tumble::scenarios {

/// Returns the part of a two-sided risk that one side may have spent after `share` in [0, 1] of all draws: almost
/// nothing at first, half of `risk` at the end (Lan and DeMets, Biometrika 70:659, 1983, with O'Brien and Fleming's
/// bounds), statistics.md (S13).
double spent_by(double risk, double share);

/// Sign test with interim analyses (Armitage, McPherson, Rowe, JRSS A 132:235, 1969), statistics.md (S13) to (S15). At
/// each look both sides get a bound. The probability of reaching a bound by this look, without a difference, is at most
/// the risk that may have been spent. The probabilities are exact: they use the distribution of sign sums that passed
/// no earlier bound. Zero differences are ignored. The number and times of looks are free if they do not depend on the
/// results. Cost: O(pairs * sqrt(all pairs)).
class SequentialSignTest {
 public:
  enum class Verdict { open, negative, positive };  ///< the more frequent sign

  /// Throws BadInput for a risk outside (0, 1).
  explicit SequentialSignTest(double risk);

  /// Analyses the signs so far; `share` of the draws are complete, 1 at the last look. A verdict once reached does not
  /// change. Throws BadInput for a share outside (0, 1], and if the share or a count decreases.
  Verdict look(double share, std::int64_t negative, std::int64_t positive);

  Verdict verdict() const { return verdict_; }
  /// Returns how many pairs of one sign the last look needed. If this exceeds the pairs available, no outcome could
  /// have been significant.
  std::int64_t needed() const { return needed_; }
  /// Returns the probability of a false verdict by now; never more than the risk.
  double spent() const { return 2.0 * spent_a_side_; }

 private:
  void toss(std::int64_t pairs);
  void stop_beyond(double allowed);

  double risk_;
  double share_ = 0.0, spent_a_side_ = 0.0;
  std::int64_t pairs_ = 0, needed_ = 0;
  // probability of each number of positive signs, from `lowest_` on, without an earlier stop
  std::int64_t lowest_ = 0;
  std::vector<double> going_on_ = {1.0};
  Verdict verdict_ = Verdict::open;
};

}  // namespace tumble::scenarios
