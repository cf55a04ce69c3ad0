// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Consistency of errors with reported covariances: squared errors divided by variances, one per degree of freedom.
namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. With variance 0: infinite, unless the error is 0. NaN
/// for a NaN error.
double squared_over(double error, double variance);

/// Returns the share of squares within three standard deviations; NaN counts as outside. False if there are none.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Returns the median of the squares relative to that of a normal variable. The mean would be dominated by the axis
/// with the smallest variance. False if there are none.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
