// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sample_times.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tumble/common/sample_clock.hpp"

namespace tumble::scenarios {

namespace {

/// Sample times of a record, and the jitter removed from the stamps [s]. Decreasing stamps are left for the bridge to
/// reject.
struct SampleTimes {
  std::vector<std::int64_t> times_ns;
  double mended_s = 0.0;
};

SampleTimes sample_times(const sim::ImuRecord& record) {
  SampleTimes out{.times_ns = record.time_ns};
  (void)to_sample_times(SampleClock({}), out.times_ns, out.mended_s);
  return out;
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
  std::vector<SampleTimes> times;
  double mended_s = 0.0;
  for (const sim::ImuRecord& record : sensors.imus)
    mended_s = std::max(mended_s, times.emplace_back(sample_times(record)).mended_s);
  if (mended_s == 0.0) return run(sensors);
  sim::Sensors timed = sensors;
  for (std::size_t i = 0; i < times.size(); ++i) timed.imus[i].time_ns = std::move(times[i].times_ns);
  Estimate estimate = run(timed);
  restore_stamps(timed.imus.front(), sensors.imus.front(), estimate.rates);
  estimate.health["stamps_mended_s"] = mended_s;
  return estimate;
}

}  // namespace tumble::scenarios
