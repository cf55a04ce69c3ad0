// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sample_times.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "tumble/common/sample_clock.hpp"

namespace tumble::scenarios {

namespace {

struct SampleTimes {
  std::vector<std::int64_t> times_ns;
  double corrected_jitter_s = 0.0;
};

SampleTimes sample_times(const sim::ImuRecord& record) {
  SampleTimes out{.times_ns = record.time_ns};
  (void)correct_stamps(SampleClock({}), out.times_ns, out.corrected_jitter_s);
  return out;
}

void keep_readings(const std::vector<bool>& kept, sim::ImuRecord& record) {
  keep_rows(kept, record.time_ns), keep_rows(kept, record.gyro_rad_s), keep_rows(kept, record.accel_m_s2);
  keep_rows(kept, record.clip_flags), keep_rows(kept, record.magnetic_field_t);
}

void restore_stamps(const sim::ImuRecord& timed, const sim::ImuRecord& stamped, std::vector<AngularRateState>& rates) {
  const std::vector<std::int64_t>& times_ns = timed.time_ns;
  for (AngularRateState& rate : rates) {
    const auto at = std::lower_bound(times_ns.begin(), times_ns.end(), rate.time_ns);
    if (at == times_ns.end() || *at != rate.time_ns) continue;
    rate.time_ns = stamped.time_ns[static_cast<std::size_t>(at - times_ns.begin())];
  }
}

}  // namespace

Estimate without_outliers(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run) {
  std::vector<std::vector<bool>> inliers;
  std::ptrdiff_t rejected = 0;
  for (const sim::ImuRecord& record : sensors.imus) {
    const std::vector<bool>& inlier = inliers.emplace_back(bridge::find_inliers(record));
    rejected += std::count(inlier.begin(), inlier.end(), false);
  }
  if (rejected == 0) return run(sensors);
  sim::Sensors kept = sensors;
  for (std::size_t i = 0; i < inliers.size(); ++i) keep_readings(inliers[i], kept.imus[i]);
  Estimate estimate = run(kept);
  estimate.health["rejected_readings"] = static_cast<double>(rejected);
  return estimate;
}

Estimate with_sample_times(const sim::Sensors& sensors, const std::function<Estimate(const sim::Sensors&)>& run) {
  std::vector<SampleTimes> times;
  double corrected_jitter_s = 0.0;
  for (const sim::ImuRecord& record : sensors.imus)
    corrected_jitter_s = std::max(corrected_jitter_s, times.emplace_back(sample_times(record)).corrected_jitter_s);
  if (corrected_jitter_s == 0.0) return run(sensors);
  sim::Sensors timed = sensors;
  for (std::size_t i = 0; i < times.size(); ++i) timed.imus[i].time_ns = std::move(times[i].times_ns);
  Estimate estimate = run(timed);
  restore_stamps(timed.imus.front(), sensors.imus.front(), estimate.rates);
  estimate.health["time_stamps_corrected_s"] = corrected_jitter_s;
  return estimate;
}

}  // namespace tumble::scenarios
