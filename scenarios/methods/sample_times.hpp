// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// The estimated rates have the original time stamps; poses and attitudes have the corrected times. The health value
/// `time_stamps_corrected_s` is the largest correction of a time stamp [s].
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Except for methods that call the public API, all methods of this project run inside at_sample_times(), which
/// corrects sample times and removes outliers. Methods from the literature receive the original time stamps. No sample
/// is removed for a method that receives the truth, because the truth must have one value per sample.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
