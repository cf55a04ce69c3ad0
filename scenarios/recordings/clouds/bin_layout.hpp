// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// Returns why `bytes` cannot contain points of four float32 (x y z intensity); the text is empty if they can. Each of
/// these observations contradicts this layout:
///
/// - More than 1 % of the magnitudes are above 1e7 or between 0 and 1e-20, which indicates doubles or packed integers.
/// - The numbers fit another number of columns better than four columns. The criterion is the difference between the
///   histogram of each column and the histogram of all numbers. With the other number of columns, this difference is
///   clearly larger.
///
/// The function reads at most 24 000 numbers.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
