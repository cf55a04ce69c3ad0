// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// Numbers of pairs that a test needs in total if the observed effect were true. The observed effect is itself
/// uncertain; for a chance difference the number is too small.
namespace tumble::scenarios {

struct Plan {
  double risk = 0.05;  ///< probability of a false positive, two-sided; (0, 1)
  double power = 0.8;  ///< probability of detecting the observed difference; (0, 1)
};

/// Returns the number of pairs for the two-sided signed-rank test (Noether, JASA 82:645, 1987), statistics.md (S10),
/// (S11). Assumes the observed share of zeros. Infinite without a tendency; never less than the minimum to reach the
/// risk. O(n log n). Throws BadInput for an invalid plan.
double pairs_for_signed_rank(std::span<const double> differences, const Plan& plan);

/// Returns the number of pairs for the paired test of failures (Connor, Biometrics 43:207, 1987), statistics.md (S12).
/// Of `pairs` draws, only the first method failed on `only_first`, only the second on `only_second`.
double pairs_for_failures(std::int64_t only_first, std::int64_t only_second, std::int64_t pairs, const Plan& plan);

}  // namespace tumble::scenarios
