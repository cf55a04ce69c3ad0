// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/bootstrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "sim/random/stream.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kValuesMin = 6;  // for a 95 % interval: 2 / 2^5 > 5 %

using Quick = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

double middle_of(double below, double above) {
  return below == above ? below : 0.5 * (below + above);
}

double sorted_median(std::span<const double> sorted) {
  const std::size_t n = sorted.size();
  return middle_of(sorted[(n - 1) / 2], sorted[n / 2]);
}

/// Returns the acceleration of the BCa bootstrap interval of the median, equation (S3) of statistics.md. For
/// an even number of values, the acceleration is zero by symmetry.
double acceleration(std::span<const double> sorted) {
  const std::size_t n = sorted.size(), m = n / 2;
  if (n % 2 == 0) return 0.0;
  const std::array<std::pair<double, double>, 3> left = {{{middle_of(sorted[m - 1], sorted[m]), static_cast<double>(m)},
                                                          {middle_of(sorted[m], sorted[m + 1]), static_cast<double>(m)},
                                                          {middle_of(sorted[m - 1], sorted[m + 1]), 1.0}}};
  double mean = 0.0;
  for (const auto& [median, count] : left) mean += median * count / static_cast<double>(n);
  double squares = 0.0, cubes = 0.0;
  for (const auto& [median, count] : left) {
    squares += count * std::pow(mean - median, 2);
    cubes += count * std::pow(mean - median, 3);
  }
  const double a = cubes / (6.0 * std::pow(squares, 1.5));
  return std::isfinite(a) ? a : 0.0;
}

}  // namespace

MedianBootstrap::MedianBootstrap(std::size_t size, std::size_t resamples) : size_(size) {
  if (size == 0) throw BadInput("bootstrap of the median: there are no values; at least one value is needed");
  if (resamples < 100)
    throw BadInput(
        fmt::format("bootstrap of the median: the number of resamples is {}; it must be at least 100", resamples));
  sim::Stream stream(size, "statistics.bootstrap");
  const auto n = static_cast<double>(size);
  const std::size_t rank = (size + 1) / 2;
  const auto lower = static_cast<double>(rank);
  const auto place = [&](double u) { return std::min(size - 1, static_cast<std::size_t>(std::max(0.0, u) * n)); };
  middles_.reserve(resamples);
  for (std::size_t i = 0; i < resamples; ++i) {
    const double u = boost::math::ibeta_inv(lower, n - lower + 1.0, stream.uniform(), Quick());
    double v = u;
    if (size % 2 == 0) v = 1.0 - (1.0 - u) * std::pow(1.0 - stream.uniform(), 1.0 / (n - lower));
    middles_.push_back({place(u), place(v)});
  }
}

Interval MedianBootstrap::interval(std::span<const double> values, double risk) const {
  if (values.size() != size_)
    throw BadInput(fmt::format(
        "bootstrap of the median: there are {} values, but the bootstrap was created for {}; the numbers must be equal",
        values.size(), size_));
  if (!(risk > 0.0 && risk < 1.0))
    throw BadInput(
        fmt::format("bootstrap of the median: the risk is {}; it must be within (0, 1)", std::to_string(risk)));
  std::vector<double> sorted(values.begin(), values.end());
  if (std::any_of(sorted.begin(), sorted.end(), [](double v) { return std::isnan(v); }))
    throw BadInput("bootstrap of the median: a value is NaN; all values must be numbers");
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted_median(sorted);
  if (size_ < kValuesMin) return {median, -kInfinity, kInfinity};

  std::vector<double> medians;
  medians.reserve(middles_.size());
  for (const Middle& middle : middles_) medians.push_back(middle_of(sorted[middle.below], sorted[middle.above]));
  std::sort(medians.begin(), medians.end());
  const auto [first, last] = std::equal_range(medians.begin(), medians.end(), median);
  const auto count = static_cast<double>(medians.size());
  const double below = static_cast<double>(first - medians.begin()) + 0.5 * static_cast<double>(last - first);
  const boost::math::normal normal;
  const double z0 = quantile(normal, std::clamp(below / count, 0.5 / count, 1.0 - 0.5 / count));
  const double a = acceleration(sorted);
  const auto end_at = [&](double share) {
    const double z = z0 + quantile(normal, share);
    return tumble::scenarios::quantile(medians, cdf(normal, z0 + z / (1.0 - a * z)));
  };
  return {median, end_at(0.5 * risk), end_at(1.0 - 0.5 * risk)};
}

}  // namespace tumble::scenarios
