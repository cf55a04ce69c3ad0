// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace tumble::scenarios {

/// BinnedMetric is a metric that is computed only from samples in one bin: the quantity `axis` must be in [low, high).
/// Example: "rate_error_median_rad_s@clip_depth_rad_s:1:2".
struct BinnedMetric {
  std::string base;  ///< "rate_error_median_rad_s"
  std::string axis;  ///< ends in the unit: "clip_depth_rad_s"
  double low = 0.0, high = 0.0;
  std::string name() const;
};

std::optional<BinnedMetric> parse_binned(const std::string& metric);

}  // namespace tumble::scenarios
