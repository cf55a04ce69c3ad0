// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. The variance 0 gives 0 for the error 0, and otherwise
/// infinity.
double squared_over(double error, double variance);

/// NaN counts as an error outside three standard deviations.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Computes the median of the normalised squared errors, divided by the median for a normal variable; in a mean, the
/// axis with the smallest variance would dominate.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
