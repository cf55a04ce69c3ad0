// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// Calls `run` with the corrected sample times of the IMU (SampleClock) instead of the time stamps of the host
/// computer. The returned rates have the original time stamps; poses and attitudes have the corrected times. The health
/// reports the largest correction as `stamps_mended_s` [s]. If no time stamp needs correction, `run` receives
/// `sensors`, otherwise a full copy.
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Removes the samples that OutlierFilter rejects from the sensor data, and calls `run`. The health counts the rejected
/// samples in `rejected_readings`, if there are any. Without rejected samples, `run` receives `sensors`, otherwise a
/// copy.
Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Wraps the function of a method with the correction of sample times and the removal of outliers. All methods of
/// tumble use the wrapper, except methods that call the public API classes, which correct time stamps. Published
/// methods receive the original time stamps. A method that uses the truth receives all outliers, because the truth has
/// one value per sample.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
