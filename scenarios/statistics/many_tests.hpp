// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Returns p-values corrected for multiple tests (Holm, Scandinavian Journal of Statistics 6:65, 1979), statistics.md
/// (S8), in the given order. Rejecting those below a risk limits the probability of any false rejection to that risk,
/// for any dependence. NaN is no test: it is not counted and stays NaN.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
