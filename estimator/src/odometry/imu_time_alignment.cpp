// SPDX-License-Identifier: BSD-3-Clause
#include "imu_time_alignment.hpp"

#include <algorithm>
#include <limits>

#include "tumble/common/detail/imu_interpolation.hpp"

namespace tumble {

namespace {

ImuSample absent_sample(TimeNs time_ns) {
  ImuSample sample;
  sample.time_ns = time_ns;
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  return sample;
}

TimeNs newest_ns(std::size_t unit, const ImuTimeAlignment::State& state) {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return readings.empty() ? *state.first_ns : readings.back().time_ns;
}

TimeNs newest_ns(const ImuTimeAlignment::State& state) {
  TimeNs out = *state.first_ns;
  for (const std::vector<ImuSample>& readings : state.readings) {
    if (!readings.empty()) out = std::max(out, readings.back().time_ns);
  }
  return out;
}

bool is_silent(std::size_t unit, const ImuTimeAlignment::State& state) {
  return seconds(newest_ns(state) - newest_ns(unit, state)) > ImuTimeAlignment::kSilentMax_s;
}

auto samples_after_common_time(const std::vector<ImuSample>& readings, const ImuTimeAlignment::State& state) {
  return std::find_if(readings.begin(), readings.end(), [&](const ImuSample& reading) {
    return !state.newest_common_time_ns || reading.time_ns > *state.newest_common_time_ns;
  });
}

ImuSample reading_at(TimeNs time_ns, const std::vector<ImuSample>& readings) {
  const auto after = std::find_if(readings.begin(), readings.end(),
                                  [&](const ImuSample& reading) { return reading.time_ns >= time_ns; });
  if (after != readings.end() && after->time_ns == time_ns) return *after;
  if (after == readings.end() || after == readings.begin()) return absent_sample(time_ns);
  const std::span<const ImuSample> neighbours(&*(after - 1), 2);
  if (seconds(time_ns - neighbours[0].time_ns) > ImuTimeAlignment::kSilentMax_s ||
      seconds(neighbours[1].time_ns - time_ns) > ImuTimeAlignment::kSilentMax_s)
    return absent_sample(time_ns);
  ImuInterpolation unit(neighbours);
  return unit.at(time_ns, unit.samples_around(time_ns));
}

}  // namespace

Status ImuTimeAlignment::push(std::size_t unit, const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return {};
  std::vector<ImuSample>& readings = state.readings[unit];
  if (!readings.empty() && sample.time_ns <= readings.back().time_ns)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(readings.back().time_ns)};
  state.first_ns = state.first_ns ? std::min(*state.first_ns, sample.time_ns) : sample.time_ns;
  readings.push_back(sample);
  return {};
}

bool ImuTimeAlignment::next(State& state, Readings& out, bool ended) const {
  if (!state.first_ns) return false;
  choose_reference(state);
  const auto at = samples_after_common_time(state.readings[state.reference_imu], state);
  if (at == state.readings[state.reference_imu].end()) return false;
  const TimeNs time_ns = at->time_ns;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    if (!ended && !is_complete(unit, time_ns, state)) return false;
  }
  state.newest_common_time_ns = time_ns;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    std::vector<ImuSample>& readings = state.readings[unit];
    out[unit] = reading_at(time_ns, readings);
    const auto later = samples_after_common_time(readings, state);
    if (later > readings.begin() + 1) readings.erase(readings.begin(), later - 1);
  }
  return true;
}

void ImuTimeAlignment::choose_reference(State& state) const {
  const std::vector<ImuSample>& readings = state.readings[state.reference_imu];
  if (samples_after_common_time(readings, state) != readings.end() || !is_silent(state.reference_imu, state)) return;
  for (std::size_t unit = 0; unit < imu_count_; ++unit) {
    if (is_silent(unit, state)) continue;
    state.reference_imu = unit;
    return;
  }
}

bool ImuTimeAlignment::is_complete(std::size_t unit, TimeNs time_ns, const State& state) const {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return (!readings.empty() && readings.back().time_ns >= time_ns) || is_silent(unit, state);
}

}  // namespace tumble
