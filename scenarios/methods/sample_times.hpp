// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// Calls `run` with corrected sample times of the IMU (SampleClock) instead of the host's stamps. The returned rates
/// have the original stamps; poses and attitudes have the corrected times. The health reports the largest correction as
/// `stamps_mended_s` [s]. If no stamp needs correction, `run` receives `sensors`, otherwise a full copy.
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Calls `run` with the sensor data without the samples that OutlierFilter rejects. The health counts rejected samples
/// in `rejected_readings`, if there are any. If there are no outliers, `run` receives `sensors`, otherwise a copy.
Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Wraps a RunCore with the correction of sample times and the removal of outliers. Oracles and the methods of tumble
/// use this wrapper; the public API classes correct stamps themselves. Published methods use the time stamps unchanged.
/// For an oracle, outliers are kept, because the truth has one value per sample.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
