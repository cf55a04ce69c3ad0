// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

/// Infers how many columns a file without a header has from the file's numbers. Used only within
/// scenarios/recordings/clouds.
namespace tumble::scenarios {

/// Returns the reason why `bytes` do not contain points of four float32 (x y z intensity). Returns "" if nothing
/// contradicts this layout or if there are too few numbers to decide.
///
/// The function applies two criteria to the numbers of the file. (1) More than 1 % of the numbers are larger than 1e7,
/// or are not 0 and smaller than 1e-20. Halves of doubles and packed integers give numbers of this size. (2) With
/// another number of columns, the value distributions of the columns differ clearly more from each other. A wrong
/// number of columns mixes the quantities, so that all columns have similar distributions. The difference is the total
/// variation distance between the histogram of a column and the histogram of all numbers, averaged over the columns.
/// The returned text names the number of columns that fits. The cost is constant: at most 24 000 numbers are read.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
