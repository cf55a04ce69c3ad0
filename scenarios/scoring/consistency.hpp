// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Whether an error is as large as the method said: squared errors over stated variances, one per degree of freedom.
namespace tumble::scenarios {

/// An error squared over the variance that was stated of it. Where no variance was stated, no error is within it but
/// one that is none: infinite. NaN of an error that is NaN.
double squared_over(double error, double variance);

/// Share of these within three standard deviations, NaN outside of them; false without any.
bool share_within_3sigma(const std::vector<double>& squares, double& value);

/// Their median as a multiple of a normal variable's. The middle, since the mean is that of the one axis whose variance
/// is smallest. False without any.
bool normalised_median(const std::vector<double>& squares, double& value);

}  // namespace tumble::scenarios
