// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios::testing {

/// Returns the rates of an estimate with the covariances before they were increased. These covariances determine
/// whether a run is wrong. Exact up to the rounding of the added variance.
inline std::vector<RateState> rates_before_doubt(const Estimate& estimate) {
  std::vector<RateState> rates = estimate.rates;
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    rates[k].covariance_rad2_s2 -= estimate.suspect_rad2_s2[k];
  return rates;
}

}  // namespace tumble::scenarios::testing
