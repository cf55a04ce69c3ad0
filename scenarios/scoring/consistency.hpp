// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tumble::scenarios {

/// The variance 0 gives 0 for the error 0, and otherwise infinity.
double squared_over(double error, double variance);

/// NaN counts as an error outside three standard deviations.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// The median is used instead of the mean, because the axis with the smallest variance would dominate a mean.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
