// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/splitting_estimate.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdint>
#include <map>

namespace tumble::scenarios {

namespace {

constexpr double kRisk = 0.05;

std::map<std::size_t, double> sizes_of(std::span<const std::size_t> families) {
  std::map<std::size_t, double> sizes;
  for (const std::size_t family : families) ++sizes[family];
  return sizes;
}

/// Returns the number of ordered pairs of draws that are copies of different initial draws.
double unrelated_pairs(std::span<const std::size_t> families) {
  const auto n = static_cast<double>(families.size());
  double related = 0.0;
  for (const auto& [family, size] : sizes_of(families)) related += size * size;
  return n * n - related;
}

}  // namespace

void SplittingEstimate::advance(std::size_t removed, std::span<const std::size_t> copies) {
  const auto n = static_cast<double>(population_), left = n - static_cast<double>(removed);
  for (std::size_t i = 0; i < removed; ++i) {
    const double alive = n - static_cast<double>(i);
    poisson_variance_ += 1.0 / (alive * alive);
  }
  log_probability_ += std::log(left / n);
  double siblings = 0.0;
  for (const std::size_t count : copies) siblings += static_cast<double>(count * count);
  // If only one draw remains, all later draws descend from it, and interval() returns the limits 0 and 1.
  if (left > 1.0) log_correction_ += std::log((left - 1.0) * n * n / (left * (n * n - siblings)));
}

/// Equation (S30) of statistics.md. Half of the variance is added only to the logarithm of the upper limit, because the
/// median of a log-normal distribution is below its mean.
Interval SplittingEstimate::interval(std::span<const std::size_t> members, double risk) const {
  const auto n = static_cast<double>(population_), own = static_cast<double>(members.size());
  const double share = own / n, log_value = log_probability_ + std::log(share);
  const double unrelated = unrelated_pairs(members) / (n * (n - 1.0) * share * share);
  if (unrelated == 0.0) return {std::exp(log_value), 0.0, 1.0};
  const double variance = std::max(poisson_variance_ + (1.0 - share) / own, -log_correction_ - std::log(unrelated));
  const double reach = normal_quantile(1.0 - 0.5 * risk) * std::sqrt(variance);
  return {std::exp(log_value), std::exp(log_value - reach),
          std::min(1.0, std::exp(log_value + 0.5 * variance + reach))};
}

Interval SplittingEstimate::of_level(std::span<const std::size_t> families) const {
  if (log_probability_ == 0.0) return {1.0, 1.0, 1.0};
  return interval(families, kRisk);
}

Interval SplittingEstimate::of_failure(std::span<const std::size_t> families,
                                       std::span<const std::size_t> failing) const {
  if (log_probability_ == 0.0)
    return share_interval(static_cast<std::int64_t>(failing.size()), static_cast<std::int64_t>(population_));
  if (2 * failing.size() >= population_) return interval(failing, kRisk);
  // If fewer than half of the draws fail, the estimate is not log-normal. Two intervals then share the error risk; the
  // interval of the failing fraction counts all copies of one initial draw as one draw.
  const Interval level = interval(families, 0.5 * kRisk);
  const auto n = static_cast<double>(sizes_of(families).size());
  const double share = static_cast<double>(failing.size()) / static_cast<double>(population_), count = share * n;
  const double low = count > 0.0 ? boost::math::ibeta_inv(count, n - count + 1.0, 0.25 * kRisk) : 0.0;
  const double high = boost::math::ibeta_inv(count + 1.0, n - count, 1.0 - 0.25 * kRisk);
  return {level.value * share, level.low * low, std::min(1.0, level.high * high)};
}

}  // namespace tumble::scenarios
