// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {

/// A failed run counts as an infinite error.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline std::vector<double> uniform(sim::Stream& stream, std::size_t n, double low = 0.0, double high = 1.0) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(stream.uniform(low, high));
  return values;
}

}  // namespace tumble::scenarios
