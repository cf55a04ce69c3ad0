// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// Calls `run` with the corrected sample times of the IMU (SampleClock) instead of the host computer's time stamps. The
/// returned rates have the original time stamps; poses and attitudes have the corrected times. The health value
/// `stamps_mended_s` is the largest correction [s]. `run` receives a copy of `sensors` if a time stamp needs
/// correction, and otherwise `sensors` itself.
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Calls `run` without the samples that OutlierFilter rejects. If there are any, the health value `rejected_readings`
/// is their number, and `run` receives a copy of `sensors`.
Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Wraps the function of a method with the correction of sample times and the removal of outliers. All methods of
/// tumble use the wrapper, except those that call the public API, which corrects time stamps itself. Published methods
/// receive the original time stamps. A method with truth receives all outliers, because the truth has one value per
/// sample.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
