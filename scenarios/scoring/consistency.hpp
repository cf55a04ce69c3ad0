// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tumble::scenarios {

/// Returns error^2 / variance; if the variance is 0, returns 0 for the error 0 and infinity for other errors.
double squared_over(double error, double variance);

/// NaN counts as an error outside three standard deviations.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Divides the median of the normalised squared errors `squares` by the median for normally distributed errors. A mean
/// would be dominated by the axis with the smallest variance, so the function uses the median.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
