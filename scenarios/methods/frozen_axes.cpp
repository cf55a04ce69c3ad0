// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/frozen_axes.hpp"

#include <algorithm>
#include <tuple>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"

namespace tumble::scenarios {

namespace {

/// Appends the axes that are frozen at `time_ns`, or extends the last interval of these axes.
void extend(const FrozenAxes::State& state, TimeNs time_ns, std::vector<FrozenAxis>& out) {
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    for (int axis = 0; axis < 3; ++axis) {
      const FrozenAxes::Axis& now = FrozenAxes::axis(triad, axis, state);
      if (!now.frozen) continue;
      const auto known = std::find_if(out.begin(), out.end(), [&](const FrozenAxis& found) {
        return found.triad == triad && found.axis == axis && found.from_ns == now.since_ns;
      });
      if (known != out.end()) {
        known->to_ns = time_ns;
      } else {
        out.push_back({triad, axis, now.since_ns, time_ns});
      }
    }
  }
}

}  // namespace

std::string to_string(const FrozenAxis& frozen) {
  return std::string(frozen.triad == Triad::gyro ? "gyro_" : "accel_") + "xyz"[frozen.axis];
}

std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples) {
  FrozenAxes::Params params;
  params.gyro_range_rad_s = record.stated_gyro_range_rad_s;
  params.accel_range_m_s2 = record.stated_accel_range_m_s2;
  const FrozenAxes detector(params);
  FrozenAxes::State state;
  std::vector<FrozenAxis> out;
  for (const ImuSample& sample : samples) {
    detector.step(sample, state);
    extend(state, sample.time_ns, out);
  }
  std::sort(out.begin(), out.end(), [](const FrozenAxis& a, const FrozenAxis& b) {
    return std::tie(a.triad, a.axis, a.from_ns) < std::tie(b.triad, b.axis, b.from_ns);
  });
  return out;
}

}  // namespace tumble::scenarios
