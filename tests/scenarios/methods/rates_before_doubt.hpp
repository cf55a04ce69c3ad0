// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios::testing {

/// The rates of an estimate with the covariances that they had before it doubted them: by those a run is wrong or
/// right, whatever is said of it then. Exact to rounding beside what was added.
inline std::vector<RateState> rates_before_doubt(const Estimate& estimate) {
  std::vector<RateState> rates = estimate.rates;
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    rates[k].covariance_rad2_s2 -= estimate.suspect_rad2_s2[k];
  return rates;
}

}  // namespace tumble::scenarios::testing
