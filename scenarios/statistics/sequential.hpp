// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tumble::scenarios {

/// Returns the part of a two-sided risk that one side may have used after the fraction `share` in [0, 1] of all
/// simulated runs. The spent part of the risk is almost zero at first and half of `risk` at the end. The function is
/// that of Lan and DeMets (Biometrika 70:659, 1983) with O'Brien and Fleming's bounds, equation (S13) of statistics.md.
double spent_by(double risk, double share);

/// SequentialSignTest is a sign test with interim analyses (Armitage, McPherson, Rowe, JRSS A 132:235, 1969), equations
/// (S13) to (S15) of statistics.md. Each interim analysis sets a threshold for the count of positive signs and for the
/// count of negative signs. If the methods do not differ, the probability of having reached a threshold is at most the
/// part of the risk that may be spent so far. The probability of reaching a threshold is exact, because its
/// distribution excludes outcomes that reached an earlier threshold. Zero differences are ignored. The caller may
/// choose the number and times of interim analyses if they do not depend on the results. The cost is O(pairs * sqrt(all
/// pairs)).
class SequentialSignTest {
 public:
  enum class Verdict { open, negative, positive };  ///< the more frequent sign

  /// Throws BadInput for a risk outside (0, 1).
  explicit SequentialSignTest(double risk);

  /// Performs an interim analysis of all signs so far, and returns the verdict. The argument `share` is the fraction of
  /// simulated runs that are complete; it is 1 at the last analysis. A verdict does not change once it is reached.
  /// Throws BadInput for a share outside (0, 1], and if the share or a count decreases.
  Verdict look(double share, std::int64_t negative, std::int64_t positive);

  Verdict verdict() const { return verdict_; }
  /// Returns how many pairs of one sign the last analysis required for a verdict. If the required number exceeds the
  /// available pairs, no outcome could have been significant.
  std::int64_t needed() const { return needed_; }
  /// Returns the probability of a false verdict so far, which never exceeds the risk.
  double spent() const { return 2.0 * spent_a_side_; }

 private:
  void toss(std::int64_t pairs);
  void stop_beyond(double allowed);

  double risk_;
  double share_ = 0.0, spent_a_side_ = 0.0;
  std::int64_t pairs_ = 0, needed_ = 0;
  // The list `going_on_` contains the probability of each number of positive signs, starting with `lowest_`, without an
  // earlier stop.
  std::int64_t lowest_ = 0;
  std::vector<double> going_on_ = {1.0};
  Verdict verdict_ = Verdict::open;
};

}  // namespace tumble::scenarios
