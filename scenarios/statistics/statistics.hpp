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

/// Returns the sample quantile (Hyndman and Fan type 7) of the values other than NaN; NaN without such a value.
/// Infinite values rank like finite values, so that failures are worst; the quantile may be infinite. `share` is the
/// probability of the quantile, in [0, 1].
double quantile(std::span<const double> values, double share);
/// Returns the quantile of all values. Returns NaN if a value is not finite, and nothing if there are no values.
std::optional<double> quantile_of_all(std::span<const double> values, double share);
/// Writes the quantile of the values to `value`. Returns false, with `value` unchanged, if there are no values.
bool quantile_of(std::span<const double> values, double share, double& value);

/// Returns the value below which a standard normal random number is with the probability `share`, in (0, 1).
double normal_quantile(double share);

/// Returns the median of one member over all rows, as `quantile` computes it.
template <class Row>
double median_of(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*member);
  return quantile(values, 0.5);
}

/// Returns the median with its distribution-free confidence interval from order statistics (binomial). With too few
/// values, the ends of the interval are infinite.
Interval median_interval(std::span<const double> values);

/// Returns the fraction of successes with its exact confidence interval (Clopper and Pearson).
Interval share_interval(std::int64_t count, std::int64_t total);

/// Returns the values, with `worst` appended once for each failed run. Statistics of a metric use this list. If `worst`
/// is NaN, nothing is appended (scenarios/scoring/metric.hpp, `worst_value`).
std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst);

}  // namespace tumble::scenarios
