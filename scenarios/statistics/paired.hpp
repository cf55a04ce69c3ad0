// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace tumble::scenarios {

/// Exact one-sided signed-rank test (Wilcoxon, Biometrics Bulletin 1, 1945) of differences of pairs: the chance that
/// the ranks of the positive ones add up to as much as they do, or more, if each difference were as likely to have the
/// other sign. Small when the differences tend to be positive. Ties share their mean rank and the distribution is that
/// of the ranks at hand, so that it is exact with ties too; zeros say nothing and are left out; infinite differences
/// rank highest. 1 without any difference. O(n^3) time, O(n^2) memory.
double signed_rank_chance(std::span<const double> differences);

}  // namespace tumble::scenarios
