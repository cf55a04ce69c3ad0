// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// consistency.hpp compares estimation errors with reported covariances. A normalised error is a squared scalar error
/// divided by its reported variance.
namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. For the variance 0, returns 0 if the error is 0, and
/// otherwise infinity. For a NaN error, returns NaN.
double squared_over(double error, double variance);

/// Computes from the normalised errors `squares` the fraction of errors within three standard deviations. NaN counts as
/// outside. Returns false if there are no errors.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Computes the median of the normalised errors `squares`, divided by the median for a normal variable. The axis with
/// the smallest variance would dominate a mean. Returns false if there are no errors.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
