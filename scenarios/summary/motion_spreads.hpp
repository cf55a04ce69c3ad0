// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

struct Spread {
  std::string scenario;
  std::string metric;    ///< "motion_peak_rate_rad_s"
  std::string quantity;  ///< "largest rate"
  std::string unit;
  std::string published;  ///< empty if none
  /// Limits of the published values of the quantity, in `unit`. A single published value gives equal limits; without a
  /// published value, the limits are NaN.
  double published_low = std::numeric_limits<double>::quiet_NaN();
  double published_high = std::numeric_limits<double>::quiet_NaN();
  double factor = 1.0;         ///< conversion from SI to `unit`
  bool of_draws = true;        ///< false: fraction of runs or samples
  std::vector<double> values;  ///< values in SI units
  double median = 0, quantile_05 = 0, quantile_95 = 0;
};

inline constexpr const char* kPublishedMotion =
    "the published campaign of the rig (32 tumbles down a hill) and the target of the scenario 'hill'";

std::vector<Spread> motion_spreads(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
