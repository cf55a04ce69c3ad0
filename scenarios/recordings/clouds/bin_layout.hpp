// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

/// How many columns a file without a header has, by its numbers. Private to scenarios/recordings/clouds.
namespace tumble::scenarios {

/// What contradicts that `bytes` hold points of four float32, x y z intensity; "" where nothing does, or where there
/// are too few to decide.
///
/// Two signs count. (1) More than 1 % of the numbers are larger than 1e7 or, but for 0, smaller than 1e-20: halves of
/// doubles and packed integers look so. (2) Read with another number of columns, the columns differ clearly more from
/// each other. Columns that mix, because the number is wrong, are distributed alike. The difference is the total
/// variation between the histograms of a column and of all numbers, mean over the columns. The text names the number of
/// columns that fits. O(1): at most 24 000 numbers are read.
std::string contradiction_to_kitti(std::span<const char> bytes);

}  // namespace tumble::scenarios
