// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"

namespace tumble::testing {

/// Returns the quantile of the values at `share`.
inline double quantile(std::vector<double> values, double share) {
  EXPECT_FALSE(values.empty());
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace tumble::testing
