// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tumble::scenarios {

/// Share of a two-sided risk that may be spent on one side by the time that `share` in [0, 1] of all draws have been
/// seen: nearly none at first, half of `risk` at the end (Lan and DeMets, Biometrika 70:659, 1983, as O'Brien and
/// Fleming's bounds), statistics.md (S19).
double spent_by(double risk, double share);

/// Sign test that is looked at while draws still come in (Armitage, McPherson, Rowe, JRSS A 132:235, 1969),
/// statistics.md (S19) to (S21). Whenever it is looked at, both sides get a bound of which the chance to be reached now
/// or at an earlier look, were both signs equally likely on each draw, is at most what may have been spent. The chances
/// are exact, by the distribution of sums of signs that no earlier bound has ended; differences that are zero enter
/// nowhere. How often and when it is looked at is free, as long as it does not depend on what was seen. Cost: O(pairs *
/// sqrt(pairs in all)).
class SequentialSignTest {
 public:
  enum class Verdict { open, negative, positive };  ///< which sign is the more frequent one

  /// Throws BadInput on a risk beyond (0, 1).
  explicit SequentialSignTest(double risk);

  /// The signs of the differences so far; `share` of the draws have been seen, 1 at the last look. What it has once
  /// answered stays. Throws BadInput on a share beyond (0, 1], and on one, or a count of pairs, below the last look's.
  Verdict look(double share, std::int64_t negative, std::int64_t positive);

  Verdict verdict() const { return verdict_; }
  /// Of the last look: how many of its pairs a sign needed. More than there are: no outcome would have been an answer.
  std::int64_t needed() const { return needed_; }
  /// Chance that any look until now says something, were there nothing to say; never more than the risk.
  double spent() const { return 2.0 * spent_a_side_; }

 private:
  void toss(std::int64_t pairs);
  void stop_beyond(double allowed);

  double risk_;
  double share_ = 0.0, spent_a_side_ = 0.0;
  std::int64_t pairs_ = 0, needed_ = 0;
  // chance of each number of positive signs, from `lowest_` on, that no look has ended
  std::int64_t lowest_ = 0;
  std::vector<double> going_on_ = {1.0};
  Verdict verdict_ = Verdict::open;
};

}  // namespace tumble::scenarios
