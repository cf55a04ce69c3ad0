// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/common/detail/sample_check.hpp"
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

using sample_hold::kMoving_rad_s, sample_hold::kRepeatsMin, sample_hold::kMovingMin, sample_hold::kMovingMax;

constexpr int kPeriods = 100, kPhases = 24, kFineSteps = 10;
constexpr double kPeriodRangeRatio = 0.03;
// assumed averaging window of an accelerometer, as a fraction of the accelerometer's sample period
constexpr double kAccelWindowRatio = 0.5;

struct Clock {
  double period = 1.0, phase_samples = 0.0;
  double reading(double sample) const { return std::floor((sample - phase_samples) / period); }
  double clock_age_samples(double sample) const { return sample - phase_samples - period * reading(sample); }
};

std::size_t count_missed_repetitions(const Clock& clock, std::span<const std::size_t> moving,
                                     const std::vector<bool>& repeats, std::size_t most) {
  std::size_t misses = 0;
  double last_at = -1.0, last = 0.0;
  for (const std::size_t k : moving) {
    const auto at = static_cast<double>(k);
    const double before = at - 1.0 == last_at ? last : clock.reading(at - 1.0);
    last = clock.reading(at);
    last_at = at;
    if ((last == before) != repeats[k] && ++misses > most) break;
  }
  return misses;
}

struct ClockPhaseSegment {
  std::size_t missed_repetitions = 0;
  double first = 0.0;
  int count = 0;
};

ClockPhaseSegment best_clock_phases(double period, std::span<const std::size_t> moving,
                                    const std::vector<bool>& repeats, std::size_t most) {
  const auto middle = static_cast<double>(moving[moving.size() / 2]);
  std::array<std::size_t, kPhases> misses;
  ClockPhaseSegment out{most + 1};
  for (std::size_t p = 0; p < kPhases; ++p) {
    const Clock clock{period, middle + period * static_cast<double>(p) / kPhases};
    misses[p] = count_missed_repetitions(clock, moving, repeats, std::min(most, out.missed_repetitions));
    out.missed_repetitions = std::min(out.missed_repetitions, misses[p]);
  }
  // The phase of the sensor's clock is cyclic. The interval of best phases may therefore extend beyond the end of the
  // tested range and continue at its start.
  int run = 0;
  for (int p = 0; p < 2 * kPhases; ++p) {
    run = misses[static_cast<std::size_t>(p % kPhases)] == out.missed_repetitions ? std::min(run + 1, kPhases) : 0;
    if (run <= out.count) continue;
    out.count = run;
    out.first = middle + period * (p - run + 1) / kPhases;
  }
  return out;
}

// Returns the clock (period and phase) of the sensor that best predicts which samples repeat a reading.
Clock best_matching_clock(const Clock& first, double reach, int periods, std::span<const std::size_t> moving,
                          const std::vector<bool>& repeats, double& found) {
  ClockPhaseSegment best{moving.size()};
  int begin = 0, end = 0;
  const auto period = [&](double i) { return first.period * (1.0 + reach * i / periods); };
  for (int i = -periods; i <= periods; ++i) {
    const ClockPhaseSegment tried = best_clock_phases(period(i), moving, repeats, best.missed_repetitions);
    const bool same = tried.missed_repetitions == best.missed_repetitions && tried.count == best.count;
    if (same) end = i;
    if (same || tried.missed_repetitions > best.missed_repetitions) continue;
    if (tried.missed_repetitions == best.missed_repetitions && tried.count < best.count) continue;
    best = tried;
    begin = end = i;
  }
  const double middle = period(0.5 * (begin + end));
  const ClockPhaseSegment at = best_clock_phases(middle, moving, repeats, moving.size());
  found = static_cast<double>(moving.size() - at.missed_repetitions) / static_cast<double>(moving.size());
  return {middle, at.first + 0.5 * middle * (at.count - 1) / kPhases};
}

using sample_hold::kMoving_rad_s, sample_hold::kRepeatsMin, sample_hold::kSlowest;

constexpr double kMovingLeast = static_cast<double>(sample_hold::kMovingMin);
constexpr double kMemory = static_cast<double>(sample_hold::kMovingMax);

RepeatedReading repeated_reading(const RepeatDetector::RepetitionMemory& memory, const Eigen::Vector3d& reading) {
  RepeatedReading out;
  if (memory.moving < kMovingLeast || memory.repeated < kRepeatsMin * memory.moving) return out;
  out.reading_period_samples = memory.moving / std::max(1.0, memory.moving - memory.repeated);
  if (out.reading_period_samples > kSlowest) return {};
  out.repeats_reading = memory.equal_samples > 1.0 && memory.equal_samples <= kSlowest;
  out.age_samples = std::min(memory.equal_samples, kSlowest) - 0.5;
  out.reading_change = out.repeats_reading ? memory.now.reading_change : reading - memory.reading;
  return out;
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

std::optional<RepeatedReadings> find_repeated(std::span<const ImuSample> samples, Triad triad) {
  RepeatedReadings out;
  out.repeats_per_sample.assign(samples.size(), false);
  out.age_s.assign(samples.size(), 0.0);
  std::vector<std::size_t> moving;
  std::size_t repeated = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const ImuSample &now = samples[k], &before = samples[k - 1];
    out.repeats_per_sample[k] = triad == Triad::gyro ? now.angular_velocity_rad_s == before.angular_velocity_rad_s
                                                     : now.specific_force_m_s2 == before.specific_force_m_s2;
    if (now.angular_velocity_rad_s.norm() < kMoving_rad_s || moving.size() == kMovingMax) continue;
    moving.push_back(k);
    repeated += out.repeats_per_sample[k] ? 1 : 0;
  }
  const auto count = static_cast<double>(moving.size());
  if (moving.size() < kMovingMin || static_cast<double>(repeated) < kRepeatsMin * count) return std::nullopt;
  Clock clock{1.0 / (1.0 - std::min(0.95, static_cast<double>(repeated) / count)), 0.0};
  clock = best_matching_clock(clock, kPeriodRangeRatio, kPeriods, moving, out.repeats_per_sample,
                              out.regular_clock_fraction);
  clock = best_matching_clock(clock, 2.0 * kPeriodRangeRatio / kPeriods, kFineSteps, moving, out.repeats_per_sample,
                              out.regular_clock_fraction);
  const double sample_s = median_period_s(samples);
  out.period_s = clock.period * sample_s;
  if (!out.has_regular_clock()) return out;
  for (std::size_t k = 0; k < samples.size(); ++k)
    out.age_s[k] = clock.clock_age_samples(static_cast<double>(k)) * sample_s;
  if (clock.period > sample_hold::kSlowest) return out;
  const double window_ratio = triad == Triad::gyro ? 1.0 : kAccelWindowRatio;
  out.window_lag_s = 0.5 * std::max(0.0, window_ratio * out.period_s - sample_s);
  return out;
}

std::vector<Neighbours> neighbouring_readings(std::span<const ImuSample> samples, Triad triad) {
  std::vector<Neighbours> out(samples.size());
  const auto equal = [&](std::size_t a, std::size_t b) {
    return triad == Triad::gyro ? samples[a].angular_velocity_rad_s == samples[b].angular_velocity_rad_s
                                : samples[a].specific_force_m_s2 == samples[b].specific_force_m_s2;
  };
  for (std::size_t k = 1; k < samples.size(); ++k) {
    out[k].previous_sample = equal(k, k - 1) ? out[k - 1].previous_sample : &samples[k - 1];
  }
  for (std::size_t k = samples.size(); k-- > 1;) {
    out[k - 1].next_sample = equal(k, k - 1) ? out[k].next_sample : &samples[k];
  }
  return out;
}

Eigen::Vector3d RepeatedReading::change_since_new_reading() const {
  return delay_samples() / reading_period_samples * reading_change;
}

void RepeatDetector::observe_reading(const ImuSample& sample, bool clipped, State& state) const {
  const bool moves = !clipped && sample.angular_velocity_rad_s.norm() >= kMoving_rad_s;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    RepetitionMemory& memory = state.repetition[static_cast<std::size_t>(triad)];
    const Eigen::Vector3d& reading = triad_reading_of(sample, triad);
    const bool again = memory.equal_samples > 0.0 && reading == memory.reading;
    if (moves) {
      const double kept = 1.0 - 1.0 / kMemory;
      memory.moving = kept * memory.moving + 1.0;
      memory.repeated = kept * memory.repeated + (again ? 1.0 : 0.0);
    }
    memory.equal_samples = again ? memory.equal_samples + 1.0 : 1.0;
    memory.now = repeated_reading(memory, reading);
    memory.reading = reading;
  }
}

}  // namespace tumble
