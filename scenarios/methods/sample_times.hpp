// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

/// What `run` makes of sensors whose IMU samples bear the times at which they were taken (SampleClock) in the place of
/// stamps that a host put on them. Rates come out with the stamps of their samples again, poses and attitudes at those
/// times; `stamps_mended_s` of the health is the largest jitter [s]. Where no stamp is mended `run` is given `sensors`
/// themselves, else a copy, points included.
Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// What `run` makes of sensors without the samples that OutlierFilter rejects. `rejected_readings` of the health is
/// their number, where there are any. Where there are none `run` is given `sensors` themselves, else a copy, points
/// included.
Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run);

/// Both, for the methods of ours that are not the door's, which has a clock itself, and for oracles.
/// Published methods take stamps for times, as published. An oracle keeps each sample: the truth has one for each.
template <RunCore run>
Estimate at_sample_times(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  const auto timed = [&](const sim::Sensors& kept) {
    return with_sample_times(kept, [&](const sim::Sensors& given) { return run(given, parameters, oracle); });
  };
  return oracle.truth == nullptr ? without_outliers(sensors, timed) : timed(sensors);
}

}  // namespace tumble::scenarios
