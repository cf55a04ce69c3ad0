// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// consistency.hpp compares errors with reported covariances. Each normalised error is a squared error divided by its
/// variance, for one degree of freedom.
namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. For a variance of 0, the result is infinite unless the
/// error is 0. For a NaN error, the result is NaN.
double squared_over(double error, double variance);

/// Computes the fraction of normalised errors within three standard deviations; NaN counts as outside. Returns false if
/// there are no errors.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Computes the median of the normalised errors, divided by the median for a normal variable. The median is used
/// because the axis with the smallest variance would dominate a mean. Returns false if there are no errors.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
