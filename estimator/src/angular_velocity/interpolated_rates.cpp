// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// In a stream, the time of a reading is uniformly distributed over one sample period, so the standard deviation is
// 1/sqrt(12) periods. In a recording, the estimated clock of the sensor determines the time of a reading more
// accurately than in a stream.
constexpr double kReadingTimeSigma_samples = 0.29, kClockedReadingSigma_samples = 0.1;

struct TimedReading {
  double time_s = 0.0;
  Vector3d rate_rad_s = Vector3d::Zero();
  bool read = false;
};

Vector3d rate_of_change(const TimedReading& a, const TimedReading& b) {
  return (b.rate_rad_s - a.rate_rad_s) / (b.time_s - a.time_s);
}

std::optional<InterpolatedRate> between(const TimedReading& z, const TimedReading& a, const TimedReading& b,
                                        const TimedReading& c, double time_s, double moment_s) {
  const double span_s = b.time_s - a.time_s, u = (time_s - a.time_s) / span_s, v = 1.0 - u;
  if (!a.read || !b.read || !(span_s > 0.0) || u < 0.0 || v < 0.0) return std::nullopt;
  const Vector3d chord = rate_of_change(a, b);
  const Vector3d slope_a = z.read && z.time_s < a.time_s ? rate_of_change(z, b) : chord;
  const Vector3d slope_b = c.read && c.time_s > b.time_s ? rate_of_change(a, c) : chord;
  InterpolatedRate out;
  out.rate_rad_s = v * v * (1.0 + 2.0 * u) * a.rate_rad_s + u * u * (3.0 - 2.0 * u) * b.rate_rad_s +
                   span_s * u * v * (v * slope_a - u * slope_b);
  // The rate changes nonlinearly within the averaging window of a gyro reading, so readings at maxima are too low and
  // readings at minima are too high.
  const Vector3d moment = moment_s * chord, bend = span_s / 24.0 * (slope_b - slope_a);
  out.variance_rad2_s2 = moment.cwiseAbs2() + bend.cwiseAbs2();
  return out;
}

std::size_t new_reading(std::span<const AngularRateStreamKnot> window, std::size_t i) {
  while (i < window.size() && window[i].repeats_reading) ++i;
  return i;
}

bool is_within_reading_interval(const std::optional<RepeatedReadings>& repeated, double sample_s) {
  return repeated && repeated->has_regular_clock() && repeated->period_s <= sample_hold::kSlowest * sample_s;
}

}  // namespace

std::optional<InterpolatedRate> rate_between_readings(std::span<const AngularRateStreamKnot> window, std::size_t k,
                                                      double period_s) {
  if (!window[k].repeated.is_slower_than_samples()) return std::nullopt;
  const auto at = [&](std::size_t i) {
    if (i >= window.size()) return TimedReading{};
    const AngularRateStreamKnot& knot = window[i];
    const AngularRateObservation& o = knot.observation;
    const double stamp_s = seconds(o.sample.time_ns - window[k].observation.sample.time_ns);
    return TimedReading{
        stamp_s - knot.repeated.delay_samples() * period_s, o.sample.angular_velocity_rad_s,
        knot.repeated.is_slower_than_samples() && !o.has_clipped_sensing_axis() && o.partly_saturated_axes() == 0};
  };
  std::size_t b = new_reading(window, k + 1);
  while (b < window.size() && at(b).time_s < 0.0) b = new_reading(window, b + 1);
  if (b == window.size() || !at(k).read) return std::nullopt;
  std::size_t z = b - 1;
  while (z > 0 && window[z].repeats_reading) --z;
  return between(z > 0 ? at(z - 1) : TimedReading{}, at(b - 1), at(b), at(new_reading(window, b + 1)), 0.0,
                 kReadingTimeSigma_samples * period_s);
}

std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden) {
  return rates_between_readings(samples, hidden, find_repeated(samples, Triad::gyro));
}

std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden,
                                                                    const std::optional<RepeatedReadings>& repeated) {
  const double sample_s = median_period_s(samples);
  if (!is_within_reading_interval(repeated, sample_s)) return {};
  std::vector<TimedReading> own;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (repeated->repeats_per_sample[k]) continue;
    const double stamp_s = seconds(samples[k].time_ns - samples[0].time_ns);
    own.push_back({stamp_s - repeated->reading_age_s(k), samples[k].angular_velocity_rad_s, hidden[k] == 0});
  }
  std::vector<std::optional<InterpolatedRate>> out(samples.size());
  const double moment_s = kClockedReadingSigma_samples * sample_s;
  std::size_t b = 1;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double time_s = seconds(samples[k].time_ns - samples[0].time_ns);
    while (b < own.size() && own[b].time_s < time_s) ++b;
    if (b == own.size()) break;
    out[k] = between(b > 1 ? own[b - 2] : TimedReading{}, own[b - 1], own[b],
                     b + 1 < own.size() ? own[b + 1] : TimedReading{}, time_s, moment_s);
  }
  return out;
}

std::vector<Vector3d> interpolated_forces(std::span<const ImuSample> samples) {
  const std::optional<RepeatedReadings> repeated = find_repeated(samples, Triad::accelerometer);
  if (!is_within_reading_interval(repeated, median_period_s(samples))) return {};
  const auto stamp_s = [&](std::size_t k) { return seconds(samples[k].time_ns - samples[0].time_ns); };
  std::vector<std::size_t> own;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!repeated->repeats_per_sample[k]) own.push_back(k);
  }
  std::vector<Vector3d> out(samples.size());
  std::size_t b = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto reading_time_s = [&](std::size_t i) { return stamp_s(own[i]) - repeated->reading_age_s(own[i]); };
    while (b < own.size() && reading_time_s(b) < stamp_s(k)) ++b;
    out[k] = samples[k].specific_force_m_s2;
    if (b == 0 || b == own.size()) continue;
    const double span_s = reading_time_s(b) - reading_time_s(b - 1);
    const double u = span_s > 0.0 ? (stamp_s(k) - reading_time_s(b - 1)) / span_s : 0.0;
    out[k] = (1.0 - u) * samples[own[b - 1]].specific_force_m_s2 + u * samples[own[b]].specific_force_m_s2;
  }
  return out;
}

}  // namespace tumble
