// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace tumble::scenarios {

/// BinnedMetric is a metric over the samples whose measure `axis` is in [low, high), with a name such as
/// "rate_error_median_rad_s@clip_depth_rad_s:1:2". `high` may be infinite. Binned metrics are plotted as a curve over
/// the measure and appear in no table.
struct BinnedMetric {
  std::string base;  ///< "rate_error_median_rad_s"
  std::string axis;  ///< "clip_depth_rad_s"; ends in its unit, as metrics do
  double low = 0.0, high = 0.0;
  std::string name() const;
};

/// Parses the name of a binned metric. Returns nothing if the text is no binned metric.
std::optional<BinnedMetric> parse_binned(const std::string& metric);

}  // namespace tumble::scenarios
