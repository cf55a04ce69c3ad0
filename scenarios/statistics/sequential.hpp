// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tumble::scenarios {

/// Error probability that one side of a two-sided sequential test may have spent when the fraction `share` of the
/// simulated runs is complete (Lan and DeMets, Biometrika 70:659, 1983, with O'Brien and Fleming's bounds; equation
/// (S13) of statistics.md).
double spent_by(double risk, double share);

/// SequentialSignTest is a sign test with interim analyses (Armitage, McPherson, Rowe, JRSS A 132:235, 1969), equations
/// (S13) to (S15) of statistics.md. Each interim analysis sets a threshold for the number of positive and of negative
/// signs. If the methods are equally good, each sign has reached its threshold with at most the probability spent_by().
/// The number and times of the interim analyses are free, but must not depend on the results.
class SequentialSignTest {
 public:
  enum class Verdict { open, negative, positive };  ///< significantly more frequent sign

  explicit SequentialSignTest(double risk);

  /// `share` is the fraction of simulated runs that are complete: 1 at the last analysis. A verdict other than `open`
  /// is final.
  Verdict look(double share, std::int64_t negative, std::int64_t positive);

  Verdict verdict() const { return verdict_; }
  std::int64_t needed() const { return needed_; }
  double spent() const { return 2.0 * spent_a_side_; }

 private:
  void toss(std::int64_t pairs);
  void stop_beyond(double allowed);

  double risk_;
  double share_ = 0.0, spent_a_side_ = 0.0;
  std::int64_t pairs_ = 0, needed_ = 0;
  std::int64_t lowest_ = 0;
  std::vector<double> going_on_ = {1.0};
  Verdict verdict_ = Verdict::open;
};

}  // namespace tumble::scenarios
