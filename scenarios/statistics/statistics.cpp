// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTail = 0.025;  // of either side of a 95 % interval
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> sorted_numbers(std::span<const double> values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double v) { return !std::isnan(v); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double quantile_of_sorted(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return kNaN;
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  // an infinity is not interpolated: what lies above minus infinity, or at a place itself, is that value
  if (place == static_cast<double>(below) || std::isinf(sorted[below])) return sorted[below];
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// continued fraction of the incomplete beta function (DLMF 8.17.22), evaluated by the modified Lentz method
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  double c = 1.0;
  double d = 1.0 / std::max(kTiny, 1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m <= 10000; ++m) {
    for (const bool even : {true, false}) {
      const double term = even ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                               : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
      d = 1.0 + term * d;
      c = 1.0 + term / c;
      if (std::abs(d) < kTiny) d = kTiny;
      if (std::abs(c) < kTiny) c = kTiny;
      d = 1.0 / d;
      fraction *= c * d;
    }
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return fraction;
}

// regularised incomplete beta function I_x(a, b)
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  // the fraction converges fast on the near side of the mean
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

// x with I_x(a, b) = probability
double beta_quantile(double a, double b, double probability) {
  double low = 0.0;
  double high = 1.0;
  for (int step = 0; step < 200 && high - low > 1e-16; ++step) {
    const double middle = 0.5 * (low + high);
    (incomplete_beta(a, b, middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double quantile(std::span<const double> values, double share) {
  if (!(share >= 0.0 && share <= 1.0))
    throw BadInput("quantile: share is " + std::to_string(share) + ", must be within [0, 1]");
  return quantile_of_sorted(sorted_numbers(values), share);
}

Interval median_interval(std::span<const double> values) {
  const std::vector<double> sorted = sorted_numbers(values);
  const auto n = static_cast<double>(sorted.size());
  Interval interval{quantile_of_sorted(sorted, 0.5), -kInfinity, kInfinity};
  // largest rank r (from 1) with P(fewer than r of n lie below the median) <= 2.5 %
  std::size_t rank = 0;
  double cumulative = 0.0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const auto count = static_cast<double>(k);
    cumulative +=
        std::exp(std::lgamma(n + 1) - std::lgamma(count + 1) - std::lgamma(n - count + 1) - n * std::log(2.0));
    if (cumulative > kTail) break;
    rank = k + 1;
  }
  if (rank == 0) return interval;
  interval.low = sorted[rank - 1];
  interval.high = sorted[sorted.size() - rank];
  return interval;
}

std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst) {
  if (!std::isnan(worst)) values.insert(values.end(), failed, worst);
  return values;
}

Interval share_interval(std::int64_t count, std::int64_t total) {
  if (total <= 0) return {kNaN, 0.0, 1.0};
  if (count < 0 || count > total) {
    throw BadInput("share_interval: count is " + std::to_string(count) + ", must be within [0, " +
                   std::to_string(total) + "]");
  }
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(total);
  return {k / n, count == 0 ? 0.0 : beta_quantile(k, n - k + 1.0, kTail),
          count == total ? 1.0 : beta_quantile(k + 1.0, n - k, 1.0 - kTail)};
}

}  // namespace tumble::scenarios
