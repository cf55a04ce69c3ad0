// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Corrects p-values for multiple tests, for any dependence between the tests (Holm, Scandinavian Journal of Statistics
/// 6:65, 1979; equation (S8) of statistics.md). After the correction of the p-values, the probability of any false
/// rejection is at most the chosen risk.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
