// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// Interval is a statistic with its 95 % confidence interval.
struct Interval {
  double value, low, high;
};

/// Returns the sample quantile (Hyndman and Fan type 7) of the values that are not NaN, or NaN if all values are NaN.
/// Infinite values are ranked like finite values, so that failures count as worst and a quantile may be infinite. The
/// argument `share` is the probability of the quantile, in [0, 1].
double quantile(std::span<const double> values, double share);
/// Returns the quantile of all values; NaN if any value is not finite, or nothing if there are no values.
std::optional<double> quantile_of_all(std::span<const double> values, double share);
/// Writes the quantile of the values to `value`. Without values, the function returns false and leaves `value`
/// unchanged.
bool quantile_of(std::span<const double> values, double share, double& value);

/// Returns the median of one member over all rows, as `quantile` computes it.
template <class Row>
double median_of(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*member);
  return quantile(values, 0.5);
}

/// Returns the median with its distribution-free confidence interval from order statistics (binomial). The ends of the
/// interval are infinite if there are too few values.
Interval median_interval(std::span<const double> values);

/// Returns the fraction of successes with its exact confidence interval (Clopper and Pearson).
Interval share_interval(std::int64_t count, std::int64_t total);

/// Returns the values, with one value `worst` added for each failed run. All statistics of a metric use the extended
/// list of values. If `worst` is NaN, nothing is added (scenarios/scoring/metric.hpp, `worst_value`).
std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst);

}  // namespace tumble::scenarios
