// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/paired.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

struct SignedRanks {
  std::vector<std::size_t> doubled;
  std::size_t total = 0, positive = 0;  ///< sums of the doubled ranks
  double ties = 0.0;                    ///< over groups of t equal values
};

SignedRanks signed_ranks(std::span<const double> differences) {
  std::vector<double> sorted;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(sorted),
               [](double d) { return !std::isnan(d) && d != 0.0; });
  std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  SignedRanks out;
  out.doubled.resize(sorted.size());
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    for (std::size_t k = begin; k < end; ++k) {
      out.doubled[k] = begin + 1 + end;
      out.total += out.doubled[k];
      if (sorted[k] > 0.0) out.positive += out.doubled[k];
    }
    const auto tied = static_cast<double>(end - begin);
    out.ties += tied * tied * tied - tied;
    begin = end;
  }
  return out;
}

double exact_chance(const SignedRanks& ranks, std::size_t sum) {
  std::vector<double> chance(ranks.total + 1, 0.0);  // of each sum of positive ranks
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks.doubled) {
    reached += rank;
    for (std::size_t at = reached + 1; at-- > 0;) {
      chance[at] = 0.5 * (chance[at] + (at >= rank ? chance[at - rank] : 0.0));
    }
  }
  double tail = 0.0;
  for (std::size_t at = ranks.total + 1; at-- > sum;) tail += chance[at];
  return std::min(1.0, tail);
}

double normal_chance(const SignedRanks& ranks, std::size_t sum) {
  const auto n = static_cast<double>(ranks.doubled.size());
  const double middle = n * (n + 1.0) / 4.0;
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.ties / 48.0;
  const double z = (0.5 * static_cast<double>(sum) - middle - 0.5) / std::sqrt(variance);
  return cdf(complement(boost::math::normal(), z));
}

double chance_of(const SignedRanks& ranks, std::size_t sum) {
  return ranks.doubled.size() <= kExactPairsMax ? exact_chance(ranks, sum) : normal_chance(ranks, sum);
}

}  // namespace

double signed_rank_chance(std::span<const double> differences) {
  const SignedRanks ranks = signed_ranks(differences);
  return chance_of(ranks, ranks.positive);
}

double signed_rank_test(std::span<const double> differences) {
  const SignedRanks ranks = signed_ranks(differences);
  const std::size_t farther = std::max(ranks.positive, ranks.total - ranks.positive);
  return std::min(1.0, 2.0 * chance_of(ranks, farther));
}

double sign_test(std::span<const double> differences) {
  const auto rises = std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0.0; });
  const auto falls = std::count_if(differences.begin(), differences.end(), [](double d) { return d < 0.0; });
  return paired_failures_test(rises, falls);
}

double paired_failures_test(std::int64_t only_first, std::int64_t only_second) {
  if (only_first < 0 || only_second < 0)
    throw BadInput(fmt::format("test of paired failures: the number of failed runs is {}; it must be at least 0",
                               std::min(only_first, only_second)));
  const auto n = static_cast<double>(only_first + only_second);
  if (n == 0.0) return 1.0;
  const boost::math::binomial fair(n, 0.5);
  return std::min(1.0, 2.0 * cdf(fair, static_cast<double>(std::min(only_first, only_second))));
}

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
