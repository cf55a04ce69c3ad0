// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

/// The function contradiction_to_kitti infers from the numbers of a file without header how many columns the file has.
namespace tumble::scenarios {

/// Returns the reason why `bytes` cannot contain points of four float32 (x y z intensity). Returns "" if nothing
/// contradicts the layout x y z intensity, or if there are too few numbers to decide.
///
/// The function applies two criteria to the numbers in the file. Criterion 1: more than 1 % of the numbers are larger
/// than 1e7, or are not 0 and smaller than 1e-20. Halves of doubles and packed integers have values of this size.
/// Criterion 2: with another number of columns, the value distributions of the columns differ clearly more from each
/// other. A wrong number of columns mixes the quantities, so that all columns have similar distributions. The
/// difference is the total variation distance between the histogram of a column and the histogram of all numbers,
/// averaged over the columns. The returned text contains the number of columns that fits. The cost is constant: at most
/// 24 000 numbers are read.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
