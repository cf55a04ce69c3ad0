// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// Returns why `bytes` cannot contain points of four float32 (x y z intensity), or an empty text if this layout is
/// possible. Each of these observations contradicts the layout of four float32 per point:
///
/// - More than 1 % of the magnitudes are above 1e7 or between 0 and 1e-20, which indicates doubles or packed integers.
/// - The numbers fit another number of columns better than four columns. Another number of columns fits better if the
///   histograms of its columns differ clearly more from the histogram of all numbers.
///
/// The function reads at most 24 000 numbers.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
