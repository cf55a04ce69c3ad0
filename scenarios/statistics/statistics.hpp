// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// An estimate with its 95 % interval.
struct Interval {
  double value, low, high;
};

/// Sample quantile (Hyndman and Fan type 7) of the values that are not NaN; NaN when there is none.
/// An infinite value ranks as what it is (a failure counts as the worst of all), so a quantile may be infinite. `share`
/// in [0, 1].
double quantile(std::span<const double> values, double share);
/// The same of values all of which count: one that is not finite spoils the figure instead of leaving it, NaN. Nothing
/// when there are none.
std::optional<double> quantile_of_all(std::span<const double> values, double share);
/// The same into `value`, which is left as it is when there are none: false then.
bool quantile_of(std::span<const double> values, double share, double& value);

/// Median of one number of each row; as `quantile`.
template <class Row>
double median_of(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*member);
  return quantile(values, 0.5);
}

/// Median with its distribution-free interval from order statistics (binomial); infinite ends when too few values.
Interval median_interval(std::span<const double> values);

/// Share of successes with its exact interval (Clopper and Pearson).
Interval share_interval(std::int64_t count, std::int64_t total);

/// The values of the runs that have one, and the value that a run without one ranks as for each that failed: what every
/// statistic of a metric is taken over. NaN as the worst adds nothing (scenarios/scoring/metric.hpp, `worst_value`).
std::vector<double> with_failures(std::vector<double> values, std::size_t failed, double worst);

}  // namespace tumble::scenarios
