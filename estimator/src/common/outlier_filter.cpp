// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/detail/outlier_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tumble {

namespace {

using Eigen::Vector3d;

// docs/maths/outliers.md explains these thresholds.
constexpr double kRateMin_rad_s = 1.0;   // smallest jump of a gyro reading that is an outlier
constexpr double kForceMin_m_s2 = 30.0;  // smallest jump of an accelerometer reading that is an outlier
// minimum jump of an outlier, as a multiple of the difference between the readings before and after the outlier
constexpr double kOutlierRatio = 3.0;
// largest angular acceleration of a robot, divided by the specific force
constexpr double kAccelerationPerForce_rad_m = 40.0;
// largest specific force of a robot, divided by the angular acceleration
constexpr double kLever_m = 10.0;
constexpr double kRateJumpMax_rad_s = 50.0;    // largest plausible jump of the rate in a single sample
constexpr double kVelocityJumpMax_m_s = 20.0;  // largest plausible jump of the velocity in a single sample
constexpr double kNear_s = 0.1;                // maximum time between compared neighbouring readings
// If two successive time stamps differ by more than kStampStepMax_periods sample periods, the second time stamp may be
// an outlier. The outlier filter delays a sample with a suspect time stamp until the next sample arrives. If the next
// time stamp is not later than the delayed sample's time stamp, the filter rejects the delayed sample.
constexpr double kStampStepMax_periods = 1.75;

// A reading may be saturated if the reading exceeds kAtRange times the stated range, or if the reading is large and
// repeated.
constexpr double kAtRange = 0.95;
constexpr double kRepeats_rad_s = 1.0, kRepeats_m_s2 = 15.0;

constexpr std::size_t kFirstMax = 2;  // largest number of outliers at the start of a run that is detected

constexpr double kUnknown = std::numeric_limits<double>::infinity();

struct Triad {
  Vector3d ImuSample::*reading;
  std::uint8_t clip_flags;
  double range, min_repeats;

  const Vector3d& of(const ImuSample& sample) const { return sample.*reading; }
  double largest_component(const ImuSample& sample) const { return of(sample).cwiseAbs().maxCoeff(); }
  bool beyond_range(const ImuSample& sample) const {
    return range > 0.0 && largest_component(sample) > OutlierFilter::kMaxReadingToRangeRatio * range;
  }
  bool may_clip(const ImuSample& from, const ImuSample& to) const {
    if (((from.device_clip_flags | to.device_clip_flags) & clip_flags) != 0) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = of(from)[axis], b = of(to)[axis], size = std::max(std::abs(a), std::abs(b));
      if ((range > 0.0 && size >= kAtRange * range) || (a == b && size >= min_repeats)) return true;
    }
    return false;
  }
};

Triad gyro_of(const OutlierFilter::ImuRanges& device) {
  return {&ImuSample::angular_velocity_rad_s, kClipGyro, device.gyro_range_rad_s, kRepeats_rad_s};
}

Triad accel_of(const OutlierFilter::ImuRanges& device) {
  return {&ImuSample::specific_force_m_s2, kClipAccel, device.accel_range_m_s2, kRepeats_m_s2};
}

/// The subtraction uses unsigned numbers, because the difference of two signed 64-bit time stamps may overflow.
double step_s(const ImuSample& from, const ImuSample& to) {
  return 1e-9 * static_cast<double>(static_cast<std::uint64_t>(to.time_ns) - static_cast<std::uint64_t>(from.time_ns));
}

/// the last accepted samples, followed by the samples under test, oldest first
struct RecentTriadReadings {
  std::array<const ImuSample*, 3 + OutlierFilter::kDelayedMax> samples{};
  std::size_t count = 0;

  void add(const ImuSample& sample) { samples[count++] = &sample; }
  const ImuSample& operator[](std::size_t k) const { return *samples[k]; }
};

RecentTriadReadings recent_triad_readings(const OutlierFilter::State& state) {
  RecentTriadReadings out;
  if (state.count >= 2 && step_s(state.recent_inliers[0], state.recent_inliers[1]) <= kNear_s)
    out.add(state.recent_inliers[0]);
  out.add(state.recent_inliers[1]);
  return out;
}

RecentTriadReadings sequence_until(const ImuSample& last, std::span<const ImuSample> delayed,
                                   const OutlierFilter::State& state) {
  RecentTriadReadings out = recent_triad_readings(state);
  for (const ImuSample& sample : delayed) out.add(sample);
  out.add(last);
  return out;
}

/// See outliers.md (O3). Returns kUnknown if saturation may hide a change of the reading.
double largest_step(const RecentTriadReadings& sequence, const Triad& triad) {
  double out = 0.0;
  for (std::size_t k = 1; k < sequence.count; ++k) {
    if (triad.may_clip(sequence[k - 1], sequence[k])) return kUnknown;
    out = std::max(out, (triad.of(sequence[k]) - triad.of(sequence[k - 1])).cwiseAbs().maxCoeff());
  }
  return out;
}

/// See outliers.md (O4).
double largest_second_difference(const RecentTriadReadings& sequence, const Triad& triad) {
  double out = 0.0;
  for (std::size_t k = 1; k < sequence.count; ++k) {
    if (triad.may_clip(sequence[k - 1], sequence[k])) return kUnknown;
    if (k < 2) continue;
    const Vector3d bend = triad.of(sequence[k]) - 2.0 * triad.of(sequence[k - 1]) + triad.of(sequence[k - 2]);
    out = std::max(out, bend.cwiseAbs().maxCoeff());
  }
  return out;
}

/// If the reading is above or below both adjacent readings, returns the distance from the closer adjacent reading, and
/// otherwise 0: outliers.md (O1).
double distance_from_neighbours(const Vector3d& before, const Vector3d& now, const Vector3d& after) {
  double out = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = now[axis] - before[axis], to = now[axis] - after[axis];
    if (from * to > 0.0) out = std::max(out, std::min(std::abs(from), std::abs(to)));
  }
  return out;
}

/// See outliers.md (O2).
double distance(const ImuSample& sample, const OutlierFilter::State& state, const Triad& triad) {
  const ImuSample &first = state.recent_inliers[0], &last = state.recent_inliers[1];
  const Vector3d step = triad.of(sample) - triad.of(last);
  const double apart = step.cwiseAbs().maxCoeff();
  if (recent_triad_readings(state).count < 2) return apart;
  const Vector3d slope = (triad.of(last) - triad.of(first)) / step_s(first, last);
  return std::min(apart, (step - step_s(last, sample) * slope).cwiseAbs().maxCoeff());
}

double gyro_threshold(const OutlierFilter::ImuRanges& device, const RecentTriadReadings& sequence,
                      const ImuSample& judged, double step) {
  if (gyro_of(device).beyond_range(judged)) return kRateMin_rad_s;
  const double caused = kAccelerationPerForce_rad_m * step * largest_step(sequence, accel_of(device));
  return std::clamp(caused, kRateMin_rad_s, kRateJumpMax_rad_s);
}

double accel_threshold(const OutlierFilter::ImuRanges& device, const RecentTriadReadings& sequence,
                       const ImuSample& judged, double step) {
  if (accel_of(device).beyond_range(judged)) return kForceMin_m_s2;
  const double caused = kLever_m / step * largest_second_difference(sequence, gyro_of(device));
  return std::clamp(caused, kForceMin_m_s2, std::max(kForceMin_m_s2, kVelocityJumpMax_m_s / step));
}

}  // namespace

void OutlierFilter::mark_accepted(const ImuSample& sample, State& state) {
  state.recent_inliers[0] = state.recent_inliers[1];
  state.recent_inliers[1] = sample;
  state.count = std::min(state.count + 1, kFirstMax + 1);
}

void OutlierFilter::finish(State& state) {
  state.rejected += std::exchange(state.delayed_count, 0);
}

OutlierFilter::Verdict OutlierFilter::judge(const ImuSample& next, const State& state) const {
  const std::span<const ImuSample> delayed = state.delayed_samples();
  if (next.time_ns <= delayed.back().time_ns) return Verdict::rejected;
  if (is_implausible(next)) return Verdict::delayed;
  bool all = true;
  for (std::size_t k = 0; k < delayed.size(); ++k) all = all && is_outlier(k, next, state);
  if (all) return Verdict::rejected;
  const bool lasts = state.count > 0 && delayed.size() < kDelayedMax && jumps(delayed.front(), {}, state) &&
                     jumps(next, delayed, state);
  return lasts ? Verdict::delayed : Verdict::confirmed;
}

std::span<const ImuSample> OutlierFilter::filter_sample(const ImuSample& next, State& state) const {
  if (state.delayed_count == 0) return {};
  const Verdict verdict = judge(next, state);
  if (verdict == Verdict::rejected) finish(state);
  if (verdict != Verdict::confirmed) return {};
  return {state.delayed_sample.data(), std::exchange(state.delayed_count, 0)};
}

bool OutlierFilter::first_is_outlier(const ImuSample& next, const State& state) const {
  return state.count >= 1 && state.count <= kFirstMax && state.delayed_count >= state.count &&
         jumps(state.delayed_sample.front(), {}, state) && judge(next, state) != Verdict::rejected;
}

bool OutlierFilter::is_implausible(const ImuSample& sample) const {
  return gyro_of(imu_ranges_).largest_component(sample) > kRateMax_rad_s ||
         accel_of(imu_ranges_).largest_component(sample) > kForceMax_m_s2;
}

bool OutlierFilter::must_delay_for_check(const ImuSample& sample, State& state) const {
  if (is_implausible(sample)) {
    ++state.rejected;
    return true;
  }
  if (!is_outlier_candidate(sample, state)) return false;
  state.delayed_sample[state.delayed_count++] = sample;
  return true;
}

/// Returns the sample period, or infinity if no nominal sample period is stated.
double OutlierFilter::period_s(const State& state) const {
  if (!(imu_ranges_.period_s > 0.0)) return kUnknown;
  if (state.count < 2) return imu_ranges_.period_s;
  return std::max(imu_ranges_.period_s, step_s(state.recent_inliers[0], state.recent_inliers[1]));
}

bool OutlierFilter::is_outlier_candidate(const ImuSample& sample, const State& state) const {
  if (state.count == 0) return false;
  const double after_s = step_s(state.recent_inliers[1], sample);
  if (after_s > imu_ranges_.gap_max_s) return false;
  return after_s > kStampStepMax_periods * period_s(state) || jumps(sample, state.delayed_samples(), state);
}

/// Returns whether gyro or accelerometer reading jumps by more than the reading of the other sensor can explain:
/// outliers.md (O5).
bool OutlierFilter::jumps(const ImuSample& sample, std::span<const ImuSample> delayed, const State& state) const {
  if (step_s(state.recent_inliers[1], sample) > kNear_s) return false;
  const ImuSample& before = delayed.empty() ? state.recent_inliers[1] : delayed.back();
  const double step = std::max(step_s(before, sample), imu_ranges_.period_s);
  const RecentTriadReadings sequence = sequence_until(sample, delayed, state);
  return distance(sample, state, gyro_of(imu_ranges_)) > gyro_threshold(imu_ranges_, sequence, sample, step) ||
         distance(sample, state, accel_of(imu_ranges_)) > accel_threshold(imu_ranges_, sequence, sample, step);
}

/// See outliers.md (O6).
bool OutlierFilter::is_outlier(std::size_t index, const ImuSample& after, const State& state) const {
  const ImuSample &before = state.recent_inliers[1], &delayed = state.delayed_sample[index];
  if (state.count == 0 || step_s(before, delayed) > kNear_s || step_s(delayed, after) > kNear_s) return false;
  const double step =
      std::max(step_s(index == 0 ? before : state.delayed_sample[index - 1], delayed), imu_ranges_.period_s);
  const RecentTriadReadings sequence = sequence_until(after, state.delayed_samples(), state);
  const auto stands_out = [&](const Triad& triad, double threshold) {
    const double by = distance_from_neighbours(triad.of(before), triad.of(delayed), triad.of(after));
    return by > threshold && by > kOutlierRatio * distance(after, state, triad);
  };
  return stands_out(gyro_of(imu_ranges_), gyro_threshold(imu_ranges_, sequence, delayed, step)) ||
         stands_out(accel_of(imu_ranges_), accel_threshold(imu_ranges_, sequence, delayed, step));
}

std::vector<bool> find_inliers(const OutlierFilter& filter, std::span<const ImuSample> samples) {
  std::vector<bool> out(samples.size(), false);
  OutlierFilter::State state;
  std::vector<std::size_t> delayed;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (filter.first_is_outlier(samples[k], state)) {
      std::fill(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(delayed.front()), false);
      state.count = 0;
    }
    for (const ImuSample& confirmed : filter.filter_sample(samples[k], state)) {
      OutlierFilter::mark_accepted(confirmed, state);
      out[delayed.front()] = true;
      delayed.erase(delayed.begin());
    }
    if (state.delayed_count == 0) delayed.clear();
    if (!filter.must_delay_for_check(samples[k], state)) {
      OutlierFilter::mark_accepted(samples[k], state);
      out[k] = true;
    } else if (state.delayed_count > delayed.size()) {
      delayed.push_back(k);
    }
  }
  return out;
}

}  // namespace tumble
