// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

/// Tests of pairs: the same draws under two methods. Each chance is that of a result as far out, or farther, were there
/// no difference. Differences that are NaN or zero say nothing and are left out; infinite ones (one of the two failed)
/// rank highest.
namespace tumble::scenarios {

/// From how many differences on a signed-rank test is the normal approximation.
inline constexpr std::size_t kExactPairsMax = 100;

/// One-sided signed-rank test (Wilcoxon, Biometrics Bulletin 1, 1945), statistics.md (S5): the chance that the ranks of
/// the positive ones add up to as much as they do, or more, if each difference were as likely to have the other sign.
/// Small when the differences tend to be positive. Ties share their mean rank. Up to `kExactPairsMax` differences the
/// distribution is that of the ranks at hand, exact with ties too, in O(n^3) time and O(n^2) memory; beyond them normal
/// with the variance of ties and a correction for continuity, (S6). 1 without any difference.
double signed_rank_chance(std::span<const double> differences);

/// The same, two-sided: twice the smaller tail, 1 at most.
double signed_rank_test(std::span<const double> differences);

/// Exact two-sided sign test (binomial), statistics.md (S7).
double sign_test(std::span<const double> differences);

/// Exact two-sided test of paired failures (McNemar, Psychometrika 12, 1947, in its binomial form), statistics.md (S7):
/// of draws on which exactly one of two methods failed, `only_first` were the first's. Throws BadInput on a negative
/// count.
double paired_failures_test(std::int64_t only_first, std::int64_t only_second);

}  // namespace tumble::scenarios
