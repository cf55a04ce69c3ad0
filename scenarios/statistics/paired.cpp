// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/paired.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::scenarios {

double signed_rank_chance(std::span<const double> differences) {
  std::vector<double> sorted;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(sorted),
               [](double d) { return !std::isnan(d) && d != 0.0; });
  std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  // twice the mean rank is a whole number
  std::vector<std::size_t> ranks(sorted.size());
  std::size_t total = 0, positive = 0;
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    for (std::size_t k = begin; k < end; ++k) {
      ranks[k] = begin + 1 + end;
      total += ranks[k];
      if (sorted[k] > 0.0) positive += ranks[k];
    }
    begin = end;
  }
  std::vector<double> chance(total + 1, 0.0);  // of each sum of the positive ranks
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks) {
    reached += rank;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      chance[sum] = 0.5 * (chance[sum] + (sum >= rank ? chance[sum - rank] : 0.0));
    }
  }
  double tail = 0.0;
  for (std::size_t sum = total + 1; sum-- > positive;) tail += chance[sum];
  return std::min(1.0, tail);
}

}  // namespace tumble::scenarios
