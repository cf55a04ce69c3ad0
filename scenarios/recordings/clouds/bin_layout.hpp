// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// Returns why `bytes` cannot contain points of four float32 (x y z intensity), or an empty text without a
/// contradiction. Criteria:
///
/// - More than 1 % of the numbers have a magnitude above 1e7, or below 1e-20 without being 0, as halves of doubles and
///   packed integers have.
/// - With another number of columns, the distributions of the columns differ clearly more from each other. The
///   difference between the distributions is the total variation distance between the histograms of a column and of all
///   numbers, averaged over the columns.
///
/// The cost of this check is constant: at most 24 000 numbers are read.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
