// SPDX-License-Identifier: BSD-3-Clause
#include "sample_hold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

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

}  // namespace

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

}  // namespace tumble
