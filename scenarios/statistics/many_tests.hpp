// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace tumble::scenarios {

/// Chances corrected for being many (Holm, Scandinavian Journal of Statistics 6:65, 1979), statistics.md (S8), in the
/// order given: to refuse what is below a risk makes any false refusal among all of them no likelier than that risk,
/// whatever they have to do with each other. NaN is no test: it counts for nothing and stays.
std::vector<double> holm(std::span<const double> chances);

}  // namespace tumble::scenarios
