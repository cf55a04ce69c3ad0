// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// How many pairs a test needs in all, were what has been observed the truth: a plan, not a promise. The observed
/// effect is itself uncertain, and of a chance difference the number that comes out is too small.
namespace tumble::scenarios {

struct Plan {
  double risk = 0.05;  ///< of calling two alike ones different, two-sided; (0, 1)
  double power = 0.8;  ///< chance of telling apart what differs as observed; (0, 1)
};

/// Of the two-sided signed-rank test (Noether, JASA 82:645, 1987), statistics.md (S9), (S10). Zeros are taken to come
/// as often as they did. Infinite where nothing tends to either side; never fewer than the test needs to reach the risk
/// at all. O(n log n). Throws BadInput on a plan beyond its bounds.
double pairs_for_signed_rank(std::span<const double> differences, const Plan& plan);

/// Of the paired test of failures (Connor, Biometrics 43:207, 1987), statistics.md (S11): of `pairs` draws on
/// `only_first` the first alone failed, on `only_second` the second.
double pairs_for_failures(std::int64_t only_first, std::int64_t only_second, std::int64_t pairs, const Plan& plan);

}  // namespace tumble::scenarios
