// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// Returns why `bytes` cannot contain points of four float32 (x y z intensity), or an empty text if this layout is
/// possible. The layout of four float32 per point is impossible in each of these cases:
///
/// - More than 1 % of the magnitudes are above 1e7 or between 0 and 1e-20, which indicates doubles or packed integers.
/// - The number of bytes is not a multiple of 16.
/// - With another number of columns than four, the histogram of each column differs more from the histogram of all
///   numbers.
///
/// contradiction_to_kitti() reads at most 24 000 numbers of `bytes`.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
