// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// paired.hpp tests the results of two methods on the same simulated runs. If the methods do not differ, the p-value is
/// the probability of a result at least as extreme as the observed one. Differences that are NaN or zero are ignored.
/// Infinite differences (one method failed) get the highest ranks.
namespace tumble::scenarios {

/// With more than kExactPairsMax differences, the signed-rank test uses the normal approximation.
inline constexpr std::size_t kExactPairsMax = 100;

/// Returns the one-sided p-value of the signed-rank test (Wilcoxon, Biometrics Bulletin 1, 1945), equation (S5) of
/// statistics.md. The p-value is small if the differences tend to be positive. Differences of equal magnitude get the
/// mean of their ranks. For up to `kExactPairsMax` differences, the p-value is exact, in O(n^3) time and O(n^2) memory.
/// For more, it is a normal approximation with corrections for ties and continuity, equation (S6). Returns 1 if there
/// are no differences.
double signed_rank_chance(std::span<const double> differences);

/// Returns the two-sided p-value of the signed-rank test: twice the smaller one-sided p-value, but at most 1.
double signed_rank_test(std::span<const double> differences);

/// Returns the p-value of the exact two-sided sign test (binomial), equation (S7) of statistics.md.
double sign_test(std::span<const double> differences);

/// Returns the p-value of the exact two-sided test of paired failures (McNemar, Psychometrika 12, 1947, in its binomial
/// form), equation (S7) of statistics.md. Only the first method failed on `only_first` simulated runs, and only the
/// second method failed on `only_second` runs. Throws BadInput for a negative count.
double paired_failures_test(std::int64_t only_first, std::int64_t only_second);

}  // namespace tumble::scenarios
