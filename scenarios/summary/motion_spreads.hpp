// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

/// Compares simulated motions with the published campaign of the tumbling rig.
namespace tumble::scenarios {

/// One quantity of one scenario over its draws; draws without a value are omitted.
struct Spread {
  std::string scenario;
  std::string metric;    ///< "motion_peak_rate_rad_s"
  std::string quantity;  ///< "largest rate"
  std::string unit;
  std::string published;  ///< text about the published value; empty if none
  /// Published range in `unit`; equal: one number; NaN: none.
  double published_low = std::numeric_limits<double>::quiet_NaN();
  double published_high = std::numeric_limits<double>::quiet_NaN();
  double factor = 1.0;         ///< from SI to `unit`
  bool of_draws = true;        ///< values per draw, not a share of draws or samples
  std::vector<double> values;  ///< SI
  double median = 0, quantile_05 = 0, quantile_95 = 0;
};

/// Source of the `published` values; follows the word "beside" in the text.
inline constexpr const char* kPublishedMotion =
    "the published campaign of the rig (32 tumbles down a hill) and the target of the scenario hill";

/// Returns one spread per quantity and scenario, scenarios in the order of the draws. For a share of draws ("draws that
/// clip the gyro") values are 0 or 1. The median is then the share, and the quantiles are its 95 % interval. The same
/// holds for a share of all clipped samples, weighted by each draw's number of them.
std::vector<Spread> motion_spreads(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
