// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. The variance 0 gives 0 for the error 0, and otherwise
/// infinity.
double squared_over(double error, double variance);

/// Computes from the normalised errors `squares` the fraction of errors within three standard deviations; NaN counts as
/// outside.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Computes the median of the normalised errors `squares`, divided by the median for a normal variable. In a mean, the
/// axis with the smallest variance would dominate.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
