// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sample_times.hpp"

#include <algorithm>
#include <optional>

#include "tumble/common/sample_clock.hpp"

namespace tumble::scenarios {

namespace {

/// Times of the samples in the place of the record's stamps; the jitter that was mended [s]. Stamps that are no times
/// (they go back) stay: the bridge refuses them.
double mend(sim::ImuRecord& record) {
  double mended_s = 0.0;
  (void)to_sample_times(SampleClock({}), record.time_ns, mended_s);
  return mended_s;
}

bool any_jitters(const sim::Sensors& sensors) {
  return std::any_of(sensors.imus.begin(), sensors.imus.end(), [](const sim::ImuRecord& record) {
    std::vector<std::int64_t> times_ns = record.time_ns;
    double mended_s = 0.0;
    return to_sample_times(SampleClock({}), times_ns, mended_s).ok() && mended_s > 0.0;
  });
}

void restore_stamps(const sim::ImuRecord& timed, const sim::ImuRecord& stamped, std::vector<RateState>& rates) {
  const std::vector<std::int64_t>& times_ns = timed.time_ns;
  for (RateState& rate : rates) {
    const auto at = std::lower_bound(times_ns.begin(), times_ns.end(), rate.time_ns);
    if (at == times_ns.end() || *at != rate.time_ns) continue;
    rate.time_ns = stamped.time_ns[static_cast<std::size_t>(at - times_ns.begin())];
  }
}

}  // namespace

Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run) {
  if (!any_jitters(sensors)) return run(sensors);
  sim::Sensors timed = sensors;
  double mended_s = 0.0;
  for (sim::ImuRecord& record : timed.imus) mended_s = std::max(mended_s, mend(record));
  Estimate estimate = run(timed);
  restore_stamps(timed.imus.front(), sensors.imus.front(), estimate.rates);
  estimate.health["stamps_mended_s"] = mended_s;
  return estimate;
}

}  // namespace tumble::scenarios
