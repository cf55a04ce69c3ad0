// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Returns p-values corrected for multiple tests, in the order of `chances` (Holm, Scandinavian Journal of Statistics
/// 6:65, 1979; statistics.md (S8)). If all hypotheses with a corrected p-value below a risk are rejected, the
/// probability of any false rejection is at most the risk. The bound on false rejections holds for any dependence of
/// the tests. NaN means that there is no test; it is not counted and stays NaN.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
