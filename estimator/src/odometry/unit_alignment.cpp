// SPDX-License-Identifier: BSD-3-Clause
#include "unit_alignment.hpp"

#include <algorithm>
#include <limits>

#include "tumble/common/detail/imu_interpolation.hpp"

namespace tumble {

namespace {

ImuSample absent(TimeNs time_ns) {
  ImuSample sample;
  sample.time_ns = time_ns;
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
  return sample;
}

/// Returns the newest time stamp of an IMU, or without readings the first time stamp of all IMUs.
TimeNs newest_ns(std::size_t unit, const UnitAlignment::State& state) {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return readings.empty() ? *state.first_ns : readings.back().time_ns;
}

TimeNs newest_ns(const UnitAlignment::State& state) {
  TimeNs out = *state.first_ns;
  for (const std::vector<ImuSample>& readings : state.readings) {
    if (!readings.empty()) out = std::max(out, readings.back().time_ns);
  }
  return out;
}

bool is_silent(std::size_t unit, const UnitAlignment::State& state) {
  return seconds(newest_ns(state) - newest_ns(unit, state)) > UnitAlignment::kSilentMax_s;
}

auto after_common(const std::vector<ImuSample>& readings, const UnitAlignment::State& state) {
  return std::find_if(readings.begin(), readings.end(),
                      [&](const ImuSample& reading) { return !state.common_ns || reading.time_ns > *state.common_ns; });
}

ImuSample reading_at(TimeNs time_ns, const std::vector<ImuSample>& readings) {
  const auto after = std::find_if(readings.begin(), readings.end(),
                                  [&](const ImuSample& reading) { return reading.time_ns >= time_ns; });
  if (after != readings.end() && after->time_ns == time_ns) return *after;
  if (after == readings.end() || after == readings.begin()) return absent(time_ns);
  const std::span<const ImuSample> neighbours(&*(after - 1), 2);
  if (seconds(time_ns - neighbours[0].time_ns) > UnitAlignment::kSilentMax_s ||
      seconds(neighbours[1].time_ns - time_ns) > UnitAlignment::kSilentMax_s)
    return absent(time_ns);
  ImuInterpolation unit(neighbours);
  return unit.at(time_ns, unit.around(time_ns));
}

}  // namespace

Status UnitAlignment::push(std::size_t unit, const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return {};
  std::vector<ImuSample>& readings = state.readings[unit];
  if (!readings.empty() && sample.time_ns <= readings.back().time_ns)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(readings.back().time_ns)};
  state.first_ns = state.first_ns ? std::min(*state.first_ns, sample.time_ns) : sample.time_ns;
  readings.push_back(sample);
  return {};
}

bool UnitAlignment::next(State& state, Readings& out, bool ended) const {
  if (!state.first_ns) return false;
  choose_reference(state);
  const auto at = after_common(state.readings[state.reference], state);
  if (at == state.readings[state.reference].end()) return false;
  const TimeNs time_ns = at->time_ns;
  for (std::size_t unit = 0; unit < units_; ++unit) {
    if (!ended && !is_complete(unit, time_ns, state)) return false;
  }
  state.common_ns = time_ns;
  for (std::size_t unit = 0; unit < units_; ++unit) {
    std::vector<ImuSample>& readings = state.readings[unit];
    out[unit] = reading_at(time_ns, readings);
    const auto later = after_common(readings, state);
    if (later > readings.begin() + 1) readings.erase(readings.begin(), later - 1);
  }
  return true;
}

/// A silent reference IMU is replaced by another IMU.
void UnitAlignment::choose_reference(State& state) const {
  const std::vector<ImuSample>& readings = state.readings[state.reference];
  if (after_common(readings, state) != readings.end() || !is_silent(state.reference, state)) return;
  for (std::size_t unit = 0; unit < units_; ++unit) {
    if (is_silent(unit, state)) continue;
    state.reference = unit;
    return;
  }
}

bool UnitAlignment::is_complete(std::size_t unit, TimeNs time_ns, const State& state) const {
  const std::vector<ImuSample>& readings = state.readings[unit];
  return (!readings.empty() && readings.back().time_ns >= time_ns) || is_silent(unit, state);
}

}  // namespace tumble
