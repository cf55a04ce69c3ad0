// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Corrects the p-values `chances` for multiple tests, for any dependence between the tests (Holm, Scandinavian Journal
/// of Statistics 6:65, 1979; equation (S8) of statistics.md). Rejecting all hypotheses with a corrected p-value below a
/// risk gives a probability of at most this risk for any false rejection.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
