// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTail = 0.025;  // tail of a 95 % interval

std::vector<double> numbers_of(std::span<const double> values) {
  std::vector<double> numbers;
  std::copy_if(values.begin(), values.end(), std::back_inserter(numbers), [](double v) { return !std::isnan(v); });
  return numbers;
}

struct RankPlace {
  RankPlace(double share, std::size_t count) {
    const double place = share * static_cast<double>(count - 1);
    below = static_cast<std::size_t>(place);
    above = std::min(below + 1, count - 1);
    part = place - static_cast<double>(below);
  }
  double between(double low, double high) const {
    return part == 0.0 || std::isinf(low) ? low : low + part * (high - low);
  }
  std::size_t below, above;
  double part;
};

}  // namespace

double quantile(std::span<const double> values, double share) {
  if (!(share >= 0.0 && share <= 1.0))
    throw BadInput(fmt::format("quantile: the probability is {}; it must be within [0, 1]", std::to_string(share)));
  std::vector<double> numbers = numbers_of(values);
  if (numbers.empty()) return kNaN;
  const RankPlace place(share, numbers.size());
  const auto below = numbers.begin() + static_cast<std::ptrdiff_t>(place.below);
  std::nth_element(numbers.begin(), below, numbers.end());
  const double above = place.above == place.below ? *below : *std::min_element(below + 1, numbers.end());
  return place.between(*below, above);
}

double normal_quantile(double share) {
  return boost::math::quantile(boost::math::normal(), share);
}

std::optional<double> quantile_of_all(std::span<const double> values, double share) {
  if (values.empty()) return std::nullopt;
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return finite ? quantile(values, share) : kNaN;
}

bool quantile_of(std::span<const double> values, double share, double& value) {
  const std::optional<double> found = quantile_of_all(values, share);
  if (found) value = *found;
  return found.has_value();
}

namespace {

std::size_t tail_rank(std::size_t values) {
  const auto n = static_cast<double>(values);
  const auto exponent = [&](std::size_t k) {
    const auto count = static_cast<double>(k);
    return std::lgamma(n + 1) - std::lgamma(count + 1) - std::lgamma(n - count + 1) - n * std::log(2.0);
  };
  constexpr double kNothing = -750.0;
  std::size_t first = 0;
  for (std::size_t above = values / 2; first < above;) {
    const std::size_t middle = first + (above - first) / 2;
    if (exponent(middle) < kNothing)
      first = middle + 1;
    else
      above = middle;
  }
  std::size_t rank = first;
  double cumulative = 0.0;
  for (std::size_t k = first; k < values; ++k) {
    cumulative += std::exp(exponent(k));
    if (cumulative > kTail) break;
    rank = k + 1;
  }
  return rank;
}

}  // namespace

Interval median_interval(std::span<const double> values) {
  std::vector<double> numbers = numbers_of(values);
  Interval interval{kNaN, -kInfinity, kInfinity};
  if (numbers.empty()) return interval;
  const RankPlace middle(0.5, numbers.size());
  const auto begin = numbers.begin(), below = begin + static_cast<std::ptrdiff_t>(middle.below);
  std::nth_element(begin, below, numbers.end());
  const auto above = middle.above == middle.below ? below : std::min_element(below + 1, numbers.end());
  interval.value = middle.between(*below, *above);
  const std::size_t rank = tail_rank(numbers.size());
  if (rank == 0) return interval;
  const auto low = begin + static_cast<std::ptrdiff_t>(rank - 1),
             high = numbers.end() - static_cast<std::ptrdiff_t>(rank);
  if (low < below) std::nth_element(begin, low, below);
  if (high > below) std::nth_element(below + 1, high, numbers.end());
  interval.low = *low;
  interval.high = *high;
  return interval;
}

std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst) {
  if (!std::isnan(worst)) values.insert(values.end(), failed, worst);
  return values;
}

Interval share_interval(std::int64_t count, std::int64_t total) {
  if (total <= 0) return {kNaN, 0.0, 1.0};
  if (count < 0 || count > total) {
    throw BadInput(
        fmt::format("confidence interval of a fraction: the count is {}; it must be within [0, {}]", count, total));
  }
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(total);
  // The Clopper-Pearson interval is equation (S24) of statistics.md.
  return {k / n, count == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, kTail),
          count == total ? 1.0 : boost::math::ibetac_inv(k + 1.0, n - k, kTail)};
}

}  // namespace tumble::scenarios
