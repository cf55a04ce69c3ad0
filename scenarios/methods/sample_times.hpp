// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// Runs a method with corrected sample times. The estimated rates have the original time stamps; poses and attitudes
/// have the corrected times. The health value `time_stamps_corrected_s` is the largest correction of a time stamp [s].
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// All methods of this project, except methods that call the public API, run inside at_sample_times(), which corrects
/// sample times and removes outliers. Methods from the literature receive the original time stamps. If a method
/// receives the truth, no sample is removed, because the truth has one value per sample.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
