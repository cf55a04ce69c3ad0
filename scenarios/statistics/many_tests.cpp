// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/many_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tumble::scenarios {

std::vector<double> holm(std::span<const double> chances) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < chances.size(); ++i) {
    if (!std::isnan(chances[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return chances[a] < chances[b]; });
  std::vector<double> corrected(chances.begin(), chances.end());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    largest = std::max(largest, static_cast<double>(order.size() - rank) * chances[order[rank]]);
    corrected[order[rank]] = std::min(1.0, largest);
  }
  return corrected;
}

}  // namespace tumble::scenarios
