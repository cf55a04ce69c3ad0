// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

inline constexpr std::size_t kExactPairsMax = 100;

/// Returns the one-sided p-value of the signed-rank test (Wilcoxon, Biometrics Bulletin 1, 1945), equation (S5) of
/// statistics.md. The p-value is small if the paired differences tend to be positive. For up to
/// `kExactPairsMax` differences, the p-value is exact, in O(n^3) time and O(n^2) memory. For more than `kExactPairsMax`
/// differences, the p-value is a normal approximation, corrected for ties and continuity, equation (S6). Infinite
/// differences get the highest ranks; a difference is infinite if one of the two methods failed.
double signed_rank_chance(std::span<const double> differences);

double signed_rank_test(std::span<const double> differences);

/// Returns the p-value of the exact two-sided sign test (binomial), equation (S7) of statistics.md.
double sign_test(std::span<const double> differences);

/// Returns the p-value of the exact two-sided test of paired failures (McNemar, Psychometrika 12, 1947, in its binomial
/// form), equation (S7) of statistics.md. `only_first` is the number of simulated runs on which only the
/// first method failed. `only_second` is the number of runs on which only the second method failed.
double paired_failures_test(std::int64_t only_first, std::int64_t only_second);

/// Corrects p-values for multiple tests, for any dependence between the tests (Holm, Scandinavian Journal of Statistics
/// 6:65, 1979; equation (S8) of statistics.md). If each corrected p-value is compared with a risk, the
/// probability of any false rejection is at most this risk.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
