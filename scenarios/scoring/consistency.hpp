// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tumble::scenarios {

/// Returns error^2 / variance. If the variance is 0, returns 0 for an error of 0 and infinity for any other error.
double squared_over(double error, double variance);

/// Computes the fraction of the errors within three standard deviations. NaN counts as an error outside three standard
/// deviations.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Divides the median of the normalised squared errors `squares` by the median for normally distributed errors. The
/// median is used because the axis with the smallest variance would dominate a mean.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
