// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

/// What the simulated motions were like, beside the published campaign of the tumbling rig.
namespace tumble::scenarios {

/// One quantity of one scenario over its draws; a draw without a value (no clipped sample: no share of them) is left
/// out.
struct Spread {
  std::string scenario;
  std::string metric;    ///< "motion_peak_rate_rad_s"
  std::string quantity;  ///< "largest rate"
  std::string unit;
  std::string published;  ///< what the campaign reports; empty when nothing
  /// Range of that, in `unit`; equal: one number; NaN: none.
  double published_low = std::numeric_limits<double>::quiet_NaN();
  double published_high = std::numeric_limits<double>::quiet_NaN();
  double factor = 1.0;         ///< from SI to `unit`
  bool of_draws = true;        ///< the values' own spread, not a share of draws or of samples
  std::vector<double> values;  ///< SI
  double median = 0, quantile_05 = 0, quantile_95 = 0;
};

/// Whose figures `published` holds, to follow "beside".
inline constexpr const char* kPublishedMotion =
    "the published campaign of the rig (32 tumbles down a hill) and the target of the scenario hill";

/// Quantity by quantity, scenarios in the order of the draws. Of a share of draws ("draws that clip the gyro") the
/// values are 0 or 1, the median is the share and the quantiles are its 95 % interval; so they are of a share of all
/// clipped samples, which weighs each draw by its number of them.
std::vector<Spread> motion_spreads(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
