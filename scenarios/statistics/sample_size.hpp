// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// The functions in sample_size.hpp compute how many pairs a test needs to detect an effect that is as large as the
/// observed effect. The observed effect is uncertain. If the observed effect is due to chance, the computed number of
/// pairs is too small.
namespace tumble::scenarios {

struct Plan {
  double risk = 0.05;  ///< probability of a false positive, two-sided; (0, 1)
  double power = 0.8;  ///< probability of detecting the observed difference; (0, 1)
};

/// Returns the number of pairs for the two-sided signed-rank test (Noether, JASA 82:645, 1987), equations (S10) and
/// (S11) of statistics.md. The formula assumes that the fraction of zero differences does not change. The returned
/// number of pairs is at least the minimum that can be significant. The number of pairs is infinite if positive and
/// negative differences are balanced. The cost is O(n log n). Throws BadInput for an invalid plan.
double pairs_for_signed_rank(std::span<const double> differences, const Plan& plan);

/// Returns the number of pairs for the paired test of failures (Connor, Biometrics 43:207, 1987), equation (S12) of
/// statistics.md. Among `pairs` simulated runs, only the first method failed in `only_first` runs, and only the second
/// method failed in `only_second` runs.
double pairs_for_failures(std::int64_t only_first, std::int64_t only_second, std::int64_t pairs, const Plan& plan);

}  // namespace tumble::scenarios
