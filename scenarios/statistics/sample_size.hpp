// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// Each function computes how many pairs a test needs to detect an effect as large as the observed effect. If the
/// observed effect is by chance larger than the true effect, the computed number of pairs is too small.
namespace tumble::scenarios {

struct Plan {
  double risk = 0.05;  ///< false positive, two-sided; (0, 1)
  double power = 0.8;  ///< detection of the effect; (0, 1)
};

/// Returns the number of pairs that the two-sided signed-rank test needs (Noether, JASA 82:645, 1987), equations (S10)
/// and (S11) of statistics.md.
double pairs_for_signed_rank(std::span<const double> differences, const Plan& plan);

/// Returns the number of pairs that the paired test of failures needs (Connor, Biometrics 43:207, 1987), equation (S12)
/// of statistics.md. In `pairs` observed runs, only the first method failed `only_first` times, and only the
/// second method failed `only_second` times.
double pairs_for_failures(std::int64_t only_first, std::int64_t only_second, std::int64_t pairs, const Plan& plan);

}  // namespace tumble::scenarios
