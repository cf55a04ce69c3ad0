// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Corrects p-values for multiple tests, in the order of `chances` (Holm, Scandinavian Journal of Statistics 6:65,
/// 1979; equation (S8) of statistics.md). If all hypotheses with a corrected p-value below a risk are rejected, the
/// probability of any false rejection is at most this risk. The bound on false rejections holds for any dependence
/// between the tests. NaN means that there is no test; NaN is not counted and is returned unchanged.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
