// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "rate_stream_impl.hpp"

namespace tumble {

namespace {

constexpr int kBeside = ImpactDelayCorrelation::kDelayMax_samples;
// The correlation sums of rate_stream.md (R104) have exponentially decreasing weights. The weight of a gyro interval
// decreases to 1/e after kMemory further gyro intervals.
constexpr double kMemory = 2000.0;
constexpr TimeNs kUpdatePeriod_ns = 50'000'000;
constexpr double kDelayChangeMin_s = 3e-4;
constexpr double kContradictionOdds = 0.05, kGuessSigmasMax = 3.0;
// The delay is estimated only after a minimum number of impacts, because a few impacts may correlate with rate changes
// by chance.
constexpr double kIntervalsMin = 150.0, kCorrelationGainMin = 0.06;
// maximum accelerometer delay, in prior standard deviations of the delay
constexpr double kReach = 3.0;

double seconds_to(const AngularRateStream::Knot& a, const AngularRateStream::Knot& b) {
  return seconds(b.observation.sample.time_ns - a.observation.sample.time_ns);
}

bool repeats_readings(const AngularRateStream::State& state) {
  return state.repetition_state.for_triad(Triad::gyro).is_slower_than_samples() ||
         state.repetition_state.for_triad(Triad::accelerometer).is_slower_than_samples();
}

// The norm of the specific force is assumed linear between readings, and constant before the first and after the last
// reading.
class ForceNormIntegral {
 public:
  ForceNormIntegral(const std::vector<AngularRateStream::Knot>& window, std::size_t middle, std::size_t first) {
    for (std::size_t i = 0; i < kReadings; ++i) {
      const AngularRateStream::Knot& knot = window[first + i];
      time_s_[i] = seconds_to(window[middle], knot);
      norm_[i] = knot.received_force.force_m_s2.norm();
      if (i > 0) sum_[i] = sum_[i - 1] + 0.5 * (norm_[i] + norm_[i - 1]) * (time_s_[i] - time_s_[i - 1]);
    }
  }
  static constexpr std::size_t kReadings = 2 * kBeside + 2;

  double integral_until(double time_s, std::size_t& from) const {
    if (time_s <= time_s_.front()) return norm_.front() * (time_s - time_s_.front());
    if (time_s >= time_s_.back()) return sum_.back() + norm_.back() * (time_s - time_s_.back());
    while (from + 2 < kReadings && time_s_[from + 1] <= time_s) ++from;
    const double u = time_s - time_s_[from];
    const double slope = (norm_[from + 1] - norm_[from]) / (time_s_[from + 1] - time_s_[from]);
    return sum_[from] + u * (norm_[from] + 0.5 * slope * u);
  }

 private:
  std::array<double, kReadings> time_s_{}, norm_{}, sum_{};
};

}  // namespace

std::ptrdiff_t AngularRateStream::Impl::force_delay_samples(const State& state) const {
  return std::lround(state.sensor_errors.front().accel_delay_state.applied_delay_s / params.period_s);
}

// See rate_stream.md (R105).
void AngularRateStream::Impl::pair_force_with_rate(std::size_t k, State& state) const {
  Knot& knot = state.window[k];
  const auto last = static_cast<std::ptrdiff_t>(state.window.size()) - 1;
  const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(k), wanted = own + force_delay_samples(state);
  // If the window does not contain the delayed specific force, the function uses the specific force of the same sample
  // or of the newest sample.
  const std::ptrdiff_t at = wanted < 0 ? own : std::min(wanted, last);
  const Knot& source = state.window[static_cast<std::size_t>(at)];
  AngularRateObservation& o = knot.observation;
  o.sample.specific_force_m_s2 = source.received_force.force_m_s2;
  o.sample.device_clip_flags =
      static_cast<std::uint8_t>((o.sample.device_clip_flags & kClipGyro) | source.received_force.device_clip_flags);
  knot.clipping_at_axis_limits.accel = source.received_force.clipped_axes;
  o.accel_age_s = (state.sensor_errors.front().accel_delay_state.applied_delay_s - prior_accelerometer_delay_s) -
                  seconds_to(knot, source);
}

std::size_t AngularRateStream::Impl::pair_newest_force(State& state) const {
  const std::size_t newest = state.window.size() - 1;
  if (state.sensor_errors.front().accel_delay_state.applied_delay_s == prior_accelerometer_delay_s &&
      force_delay_samples(state) == 0)
    return newest;
  const auto waiting = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, force_delay_samples(state)));
  const std::size_t first = newest - std::min(newest, waiting);
  for (std::size_t k = first; k <= newest; ++k) pair_force_with_rate(k, state);
  return first;
}

// See rate_stream.md (R104).
void AngularRateStream::Impl::add_impact_to_delay_correlation(State& state) const {
  if (!delay_is_estimated || state.window.size() < ForceNormIntegral::kReadings) return;
  const std::size_t first = state.window.size() - ForceNormIntegral::kReadings, after = first + kBeside + 1;
  const Knot &a = state.window[after - 1], &b = state.window[after];
  const Eigen::Vector3d &begin = a.observation.sample.angular_velocity_rad_s,
                        &end = b.observation.sample.angular_velocity_rad_s;
  if (a.observation.has_clipped_sensing_axis() || b.observation.has_clipped_sensing_axis() ||
      !ImpactDelayCorrelation::counts(begin, end))
    return;
  const ForceNormIntegral force(state.window, after, first);
  const double span_s = seconds_to(a, b), step_s = params.period_s / ImpactDelayCorrelation::kDelaysPerSample;
  ImpactDelayCorrelation::DelayGrid mean;
  std::size_t from = 0, to = 0;
  for (int i = 0; i < ImpactDelayCorrelation::kDelayCount; ++i) {
    const double delay_s = (i - ImpactDelayCorrelation::kDelayMax) * step_s;
    mean[i] = (force.integral_until(delay_s, to) - force.integral_until(delay_s - span_s, from)) / span_s;
  }
  ImpactDelayCorrelation& impacts = state.sensor_errors.front().accel_delay_state.impacts;
  impacts.decay_sums(1.0 - 1.0 / kMemory);
  impacts.add((end - begin).norm() / span_s, mean);
}

// If the device repeats readings, the delay is not estimated, because repeated readings bias the correlation of force
// and rate change.
TriadDelay AngularRateStream::Impl::estimate_delay_from_impacts(const State& state) const {
  const ImpactDelayCorrelation& impacts = state.sensor_errors.front().accel_delay_state.impacts;
  if (repeats_readings(state) || impacts.intervals < kIntervalsMin) return {};
  return impacts.estimate_delay(params.period_s, params.period_s);
}

// See rate_stream.md (R106).
void AngularRateStream::Impl::update_delay(State& state) const {
  AngularRateStreamDelay& delay = state.sensor_errors.front().accel_delay_state;
  const TimeNs now_ns = state.window.back().observation.sample.time_ns;
  if (!delay_is_estimated || (delay.updated_ns && now_ns - *delay.updated_ns < kUpdatePeriod_ns)) return;
  delay.updated_ns = now_ns;
  if (delay.delay_found && repeats_readings(state))
    return set_accelerometer_delay(prior_accelerometer_delay_s, false, state);
  const auto correlates = [&](double at_s) { return delay.impacts.force_correlation_at(at_s, params.period_s); };
  if (delay.delay_found &&
      correlates(prior_accelerometer_delay_s) - correlates(delay.applied_delay_s) > kCorrelationGainMin)
    return set_accelerometer_delay(prior_accelerometer_delay_s, false, state);
  if (const TriadDelay guess = estimate_delay_from_impacts(state); guess.sigma_s > 0.0) {
    const bool gains = correlates(guess.delay_s) - correlates(prior_accelerometer_delay_s) > kCorrelationGainMin &&
                       std::abs(guess.delay_s - prior_accelerometer_delay_s) <
                           kReach * params.model.expert.error_priors.delay_uncalibrated_s;
    const bool plain = gains && sensor_error_uncertainty.data_sheet_odds(guess.delay_s - prior_accelerometer_delay_s,
                                                                         guess.sigma_s) < kContradictionOdds;
    const bool far = std::abs(guess.delay_s - delay.applied_delay_s) > kGuessSigmasMax * guess.sigma_s;
    delay.impact_delay = guess;
    if (plain && (!delay.delay_found || far)) return set_accelerometer_delay(guess.delay_s, true, state);
    if (!plain && delay.delay_found) return set_accelerometer_delay(prior_accelerometer_delay_s, false, state);
  }
  if (delay.delay_found && std::abs(delay.estimated_s - delay.applied_delay_s) > kDelayChangeMin_s) refine_delay(state);
}

// A new accelerometer delay invalidates the calibration that was estimated with the previous delay.
void AngularRateStream::Impl::set_accelerometer_delay(double delay_s, bool found, State& state) const {
  AngularRateStreamDelay& delay = state.sensor_errors.front().accel_delay_state;
  delay.applied_delay_s = delay.estimated_s = delay_s;
  delay.delay_found = found;
  reset_rig(state);
  for (std::size_t k = 0; k < state.window.size(); ++k) pair_force_with_rate(k, state);
  classify_window_clipping(true, state);
  for (std::size_t k = 1; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    if (knot.observation.unmeasured_axes() == 0) continue;
    knot.knot_age_samples = 0;
    knot.estimate.use_soft_bounds = false;
    predict_new_knot(knot, state.window[k - 1], state);
  }
}

// See rate_stream.md (R107).
void AngularRateStream::Impl::refine_delay(State& state) const {
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  const std::ptrdiff_t before = force_delay_samples(state);
  const double step_s = device.accel_delay_state.estimated_s - device.accel_delay_state.applied_delay_s;
  device.accel_delay_state.applied_delay_s = device.accel_delay_state.estimated_s;
  state.prior.gradient += step_s * device.prior.col(SensorErrors::kDelay);
  state.prior_border_block.gradient += step_s * device.border_errors.col(SensorErrors::kDelay);
  device.sensor_error_evidence.gradient -= step_s * device.sensor_error_evidence.information.col(SensorErrors::kDelay);
  if (force_delay_samples(state) == before) {
    for (Knot& knot : state.window) knot.observation.accel_age_s += step_s;
    return;
  }
  for (std::size_t k = 0; k < state.window.size(); ++k) pair_force_with_rate(k, state);
  classify_window_clipping(true, state);
}

}  // namespace tumble
