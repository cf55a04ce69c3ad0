// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// The functions in consistency.hpp compare estimation errors with reported covariances. Each normalised error is a
/// squared error divided by its reported variance, with one degree of freedom.
namespace tumble::scenarios {

/// Returns the squared error divided by its reported variance. For a variance of 0, the result is infinite unless the
/// error is 0. For a NaN error, the result is NaN.
double squared_over(double error, double variance);

/// Computes the fraction of errors within three standard deviations from the normalised errors `squares`; NaN counts as
/// outside. Returns false if there are no errors.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Computes the median of the normalised errors `squares`, divided by the median for a normal variable. A mean would be
/// dominated by the axis with the smallest variance. Returns false if there are no errors.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
