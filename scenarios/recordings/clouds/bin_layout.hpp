// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

/// contradiction_to_kitti determines how many columns a file without header has, from its numbers.
namespace tumble::scenarios {

/// Returns why `bytes` cannot contain points of four float32 (x y z intensity). Returns an empty text if nothing
/// contradicts this layout, or if there are too few numbers to decide.
///
/// There are two criteria:
/// - More than 1 % of the numbers have a magnitude above 1e7, or below 1e-20 without being 0. Halves of doubles and
///   packed integers have such magnitudes.
/// - With another number of columns, the distributions of the columns differ clearly more from each other. A wrong
///   number of columns mixes the quantities, so that all columns have similar distributions. The difference is the
///   total variation distance between the histograms of a column and of all numbers, averaged over the columns.
///
/// The text contains the number of columns that fits. The cost is constant: at most 24 000 numbers are read.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
