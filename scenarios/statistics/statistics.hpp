// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble::scenarios {

struct Interval {
  double value, low, high;
};

/// Returns the sample quantile (Hyndman and Fan, type 7) of the values without NaN, or NaN if all values are NaN.
/// Infinite values count as the largest values, so that failures are worst.
double quantile(std::span<const double> values, double share);
std::optional<double> quantile_of_all(std::span<const double> values, double share);
bool quantile_of(std::span<const double> values, double share, double& value);

/// Returns the quantile of the standard normal distribution for the probability `share`, in (0, 1).
double normal_quantile(double share);

template <class Row>
double median_of(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*member);
  return quantile(values, 0.5);
}

/// Returns the median with its distribution-free confidence interval from order statistics (binomial). If there are too
/// few values, the ends of the confidence interval are infinite.
Interval median_interval(std::span<const double> values);

/// Returns the fraction of successes with the exact confidence interval of Clopper and Pearson.
Interval share_interval(std::int64_t count, std::int64_t total);

/// Appends the value `worst` once for each failed run. If `worst` is NaN, nothing is appended.
std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst);

}  // namespace tumble::scenarios
