// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

/// This file contains coefficients for evaluating the power series of cos(x) and sin(x) / x with Horner's method, where
/// x is half of a rotation angle.
namespace tumble::rotation_series {

/// square of the largest rotation angle for which the power series is accurate
inline constexpr double kAngle2_rad2 = 1.0;
/// ratios of successive terms in the series of cos(x) and of sin(x) / x, last term first
inline constexpr std::pair<double, double> kRatios[] = {
    {1.0 / 182, 1.0 / 210}, {1.0 / 132, 1.0 / 156}, {1.0 / 90, 1.0 / 110}, {1.0 / 56, 1.0 / 72},
    {1.0 / 30, 1.0 / 42},   {1.0 / 12, 1.0 / 20},   {1.0 / 2, 1.0 / 6}};

}  // namespace tumble::rotation_series
