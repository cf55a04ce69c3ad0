// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/estimates/method.hpp"

namespace tumble::scenarios::testing {

/// Returns the rates of an estimate with covariances that lack the terms of suspect readings: these decide whether a
/// run is wrong, whatever it reported afterwards. The result is exact to the rounding of the added terms.
inline std::vector<AngularRateState> rates_without_suspect_terms(const Estimate& estimate) {
  std::vector<AngularRateState> rates = estimate.rates;
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    rates[k].covariance_rad2_s2 -= estimate.suspect_rad2_s2[k];
  return rates;
}

}  // namespace tumble::scenarios::testing
