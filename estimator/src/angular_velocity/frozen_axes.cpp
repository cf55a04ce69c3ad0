// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/frozen_axes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

constexpr std::array<const char*, 6> kNames = {"gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"};
constexpr std::array<const char*, 6> kQuantities = {
    "time in s for which gyro x repeats one reading",  "time in s for which gyro y repeats one reading",
    "time in s for which gyro z repeats one reading",  "time in s for which accel x repeats one reading",
    "time in s for which accel y repeats one reading", "time in s for which accel z repeats one reading"};

constexpr double kAxisFrozen_s = 0.5;  // longest time for which a working axis repeats one reading while the body moves
// An axis counts as frozen if the axis repeats one reading for at least kMinRepetitionRatio times the duration of its
// longest earlier repetition.
constexpr double kMinRepetitionRatio = 10.0;
constexpr double kPossibleRailRatio = 0.9;  // fraction of the stated range above which a reading may be saturated
// fraction of the stated range above which a reading may be saturated if the device flags the reading, or if the
// reading is the smallest or largest of the axis
constexpr double kExtremeRatio = 0.5;
constexpr double kMotionQuanta = 50.0;
constexpr double kRotating_rad_s = 0.3;    // change of another gyro axis that indicates motion
constexpr double kMotionForce_m_s2 = 1.0;  // change of another accelerometer axis that indicates motion
constexpr double kChanging =
    0.2;  // minimum fraction of samples in which another axis changes; allows logs that repeat each reading five times
constexpr bool is_gyro(std::size_t channel) {
  return channel < 3;
}

constexpr std::size_t other_axis_of_triad(std::size_t channel, std::size_t k) {
  return channel / 3 * 3 + (channel + 1 + k) % 3;
}

std::array<double, 6> readings(const ImuSample& sample) {
  const Eigen::Vector3d &w = sample.angular_velocity_rad_s, &f = sample.specific_force_m_s2;
  return {w.x(), w.y(), w.z(), f.x(), f.y(), f.z()};
}

void start_repeated_reading(std::size_t channel, const std::array<double, 6>& now, TimeNs time_ns,
                            FrozenAxes::Axis& axis) {
  axis.reading = now[channel];
  axis.since_ns = time_ns;
  axis.repeated_s = axis.samples = 0.0;
  axis.flagged_by_device = axis.is_frozen = false;
  for (std::size_t k = 0; k < 2; ++k) {
    axis.other_axes_min[k] = axis.other_axes_max[k] = now[other_axis_of_triad(channel, k)];
    axis.other_axes_changes[k] = 0.0;
  }
}

}  // namespace

FrozenAxes::FrozenAxes(const ImuRanges& imu_ranges) : imu_ranges_(imu_ranges) {
  require_in_interval("gyro_range_rad_s", imu_ranges.gyro_range_rad_s, 0.0, kUnbounded);
  require_in_interval("accel_range_m_s2", imu_ranges.accel_range_m_s2, 0.0, kUnbounded);
}

void FrozenAxes::step(const ImuSample& sample, State& state) const {
  if (!check_sample(sample).ok()) return;
  if (state.started && sample.time_ns <= state.last_time_ns) return;
  const std::array<double, 6> now = readings(sample);
  const double dt_s = state.started ? seconds(sample.time_ns - state.last_time_ns) : 0.0;
  for (std::size_t c = 0; c < now.size(); ++c) {
    Axis& axis = state.axes[c];
    if (!state.started) axis.min_reading = axis.max_reading = now[c];
    axis.min_reading = std::min(axis.min_reading, now[c]);
    axis.max_reading = std::max(axis.max_reading, now[c]);
    if (!state.started || now[c] != axis.reading) {
      if (state.started) {
        const double change = std::abs(now[c] - axis.reading);
        axis.smallest_reading_change =
            axis.smallest_reading_change > 0.0 ? std::min(axis.smallest_reading_change, change) : change;
        if (!axis.is_frozen && !is_at_saturation_limit(c, axis))
          axis.longest_s = std::max(axis.longest_s, axis.repeated_s);
        axis.changing_readings_duration_s += dt_s;
      }
      start_repeated_reading(c, now, sample.time_ns, axis);
    }
    track_repeated_reading(c, now, dt_s, sample.device_clip_flags, state);
  }
  state.previous_readings = now;
  state.last_time_ns = sample.time_ns;
  state.rate_max_so_far_rad_s = std::max(state.rate_max_so_far_rad_s, sample.angular_velocity_rad_s.norm());
  state.started = true;
}

void FrozenAxes::track_repeated_reading(std::size_t channel, const std::array<double, 6>& now, double dt_s,
                                        std::uint8_t flags, State& state) const {
  Axis& axis = state.axes[channel];
  const int first = is_gyro(channel) ? kClipGyroX : kClipAccelX;
  axis.flagged_by_device = axis.flagged_by_device || (flags & first << channel % 3) != 0;
  if (state.last_time_ns >= axis.since_ns && state.started) {
    axis.repeated_s += dt_s;
    axis.samples += 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t beside = other_axis_of_triad(channel, k);
      axis.other_axes_min[k] = std::min(axis.other_axes_min[k], now[beside]);
      axis.other_axes_max[k] = std::max(axis.other_axes_max[k], now[beside]);
      if (now[beside] != state.previous_readings[beside]) axis.other_axes_changes[k] += 1.0;
    }
  }
  const bool froze = !is_at_saturation_limit(channel, axis) && axis.changing_readings_duration_s >= kAxisFrozen_s &&
                     axis.repeated_s >= std::max(kAxisFrozen_s, kMinRepetitionRatio * axis.longest_s) &&
                     other_axes_change(channel, axis);
  axis.is_frozen = axis.is_frozen || froze;
}

bool FrozenAxes::is_at_saturation_limit(std::size_t channel, const Axis& axis) const {
  const double stated = is_gyro(channel) ? imu_ranges_.gyro_range_rad_s : imu_ranges_.accel_range_m_s2;
  const double size = std::abs(axis.reading);
  if (stated > 0.0 && size >= kPossibleRailRatio * stated) return true;
  if (axis.flagged_by_device && size >= kExtremeRatio * stated) return true;
  double range = stated;
  if (stated == 0.0) {  // the axes of a sensor have nearly equal ranges, so no axis saturates far below another reading
    for (std::size_t k = 0; k < 2; ++k)
      range = std::max({range, std::abs(axis.other_axes_min[k]), std::abs(axis.other_axes_max[k])});
  }
  return size >= kExtremeRatio * range && (axis.reading == axis.min_reading || axis.reading == axis.max_reading);
}

bool FrozenAxes::other_axes_change(std::size_t channel, const Axis& axis) {
  const double least =
      std::max(is_gyro(channel) ? kRotating_rad_s : kMotionForce_m_s2, kMotionQuanta * axis.smallest_reading_change);
  for (std::size_t k = 0; k < 2; ++k) {
    const bool changes = axis.other_axes_changes[k] >= kChanging * axis.samples;
    if (changes && axis.other_axes_max[k] - axis.other_axes_min[k] >= least) return true;
  }
  return false;
}

const FrozenAxes::Axis& FrozenAxes::axis(Triad triad, int axis, const State& state) {
  return state.axes.at((triad == Triad::gyro ? 0U : 3U) + static_cast<std::size_t>(axis));
}

bool FrozenAxes::any_frozen(const State& state) {
  return std::any_of(state.axes.begin(), state.axes.end(), [](const Axis& axis) { return axis.is_frozen; });
}

void FrozenAxes::add_findings(HealthFinding::Kind kind, const std::string& sensor, const State& state,
                              SensorHealth& health) const {
  for (std::size_t c = 0; c < kQuantities.size(); ++c) {
    const Axis& axis = state.axes[c];
    if (!axis.is_frozen) continue;
    const Status status{ErrorCode::out_of_range, kQuantities[c], axis.repeated_s, kAxisFrozen_s};
    health.add(kind, status, sensor, kNames[c], axis.since_ns);
  }
}

void add_finding(HealthFinding::Kind kind, const std::string& sensor, const FrozenAxis& interval,
                 SensorHealth& health) {
  const auto channel = static_cast<std::size_t>(interval.axis + (interval.triad == Triad::gyro ? 0 : 3));
  const Status status{ErrorCode::out_of_range, kQuantities.at(channel), seconds(interval.to_ns - interval.from_ns),
                      kAxisFrozen_s};
  health.add(kind, status, sensor, kNames.at(channel), interval.from_ns);
}

Eigen::Vector3d FrozenAxes::rate_variance_rad2_s2(TimeNs time_ns, const State& state) const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    const Axis& axis = state.axes[c];
    if (axis.is_frozen && time_ns >= axis.since_ns)
      out[static_cast<int>(c)] = state.rate_max_so_far_rad_s * state.rate_max_so_far_rad_s;
  }
  return out;
}

namespace {

void extend_frozen_intervals(const FrozenAxes::State& state, TimeNs time_ns, std::vector<FrozenAxis>& out) {
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    for (int axis = 0; axis < 3; ++axis) {
      const FrozenAxes::Axis& now = FrozenAxes::axis(triad, axis, state);
      if (!now.is_frozen) continue;
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

std::vector<FrozenAxis> find_frozen_axes(const FrozenAxes& detector, std::span<const ImuSample> samples) {
  FrozenAxes::State state;
  std::vector<FrozenAxis> out;
  for (const ImuSample& sample : samples) {
    detector.step(sample, state);
    extend_frozen_intervals(state, sample.time_ns, out);
  }
  std::sort(out.begin(), out.end(), [](const FrozenAxis& a, const FrozenAxis& b) {
    return std::tie(a.triad, a.axis, a.from_ns) < std::tie(b.triad, b.axis, b.from_ns);
  });
  return out;
}

}  // namespace tumble
