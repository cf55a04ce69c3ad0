// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tumble::scenarios {

/// What stands in the middle of the values once they are in order, of an even number the upper one of the two: a value
/// that was there, as steps of clocks have to be. Scores and tables take the mean of the two instead (statistics.hpp).
/// All are finite; zero when there is none. O(n).
template <class Value>
Value upper_median(std::vector<Value> values) {
  if (values.empty()) return Value{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace tumble::scenarios
