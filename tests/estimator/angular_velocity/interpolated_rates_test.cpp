// SPDX-License-Identifier: BSD-3-Clause
// The gyro is slower than its log, so its readings are means over its own period and are old when they are logged.
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble_recording.hpp"

namespace tumble {
namespace {

constexpr double kPeriod_s = 0.01;

/// Bent is a rate with constant jerk, read every `period` samples of the log as a mean; each reading is taken half a
/// sample before it is logged.
struct Bent {
  double jerk_rad_s3 = 40.0;

  double rate(double s) const { return 1.0 + 2.0 * s + 0.5 * jerk_rad_s3 * s * s; }
  /// Returns the mean over a window that ends at `end_s`.
  double mean(double end_s, double window_s) const {
    return rate(end_s - 0.5 * window_s) + jerk_rad_s3 * window_s * window_s / 24.0;
  }
  std::vector<AngularRateStreamKnot> window(std::size_t count, std::size_t period) const {
    std::vector<AngularRateStreamKnot> out(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t said = k % period;
      ImuSample& sample = out[k].observation.sample;
      sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
      const double taken_s = kPeriod_s * (static_cast<double>(k - said) - 0.5);
      sample.angular_velocity_rad_s.x() = mean(taken_s, kPeriod_s * static_cast<double>(period));
      out[k].repeats_reading = out[k].repeated.repeats_reading = said > 0;
      out[k].repeated.age_samples = static_cast<double>(said) + 0.5;
      out[k].repeated.reading_period_samples = static_cast<double>(period);
    }
    return out;
  }
};

// The requested rate is the mean over the sample's own window. A cubic reproduces a parabola exactly, except for the
// effect of the longer window, which is stated as a deviation.
TEST(InterpolatedRates, AParabolaComesBackAtItsOwnTime) {
  const Bent motion;
  for (const std::size_t period : {2u, 3u, 4u}) {
    const std::vector<AngularRateStreamKnot> window = motion.window(24, period);
    const double window_s = kPeriod_s * static_cast<double>(period);
    const double hidden = motion.jerk_rad_s3 * (window_s * window_s - kPeriod_s * kPeriod_s) / 24.0;
    for (std::size_t k = 8; k < 14; ++k) {
      const auto found = rate_between_readings(window, k, kPeriod_s);
      ASSERT_TRUE(found.has_value()) << k;
      const double truth = motion.mean(kPeriod_s * static_cast<double>(k), kPeriod_s);
      EXPECT_NEAR(found->rate_rad_s.x() - truth, hidden, 1e-9) << k;
      EXPECT_GT(found->variance_rad2_s2.x(), hidden * hidden);
      // the reading itself is as late as its window
      EXPECT_GT(std::abs(window[k].observation.sample.angular_velocity_rad_s.x() - truth), 4.0 * hidden) << k;
    }
  }
}

TEST(InterpolatedRates, NothingIsSaidWithoutBothReadings) {
  const Bent motion;
  std::vector<AngularRateStreamKnot> window = motion.window(24, 3);
  EXPECT_FALSE(rate_between_readings(window, 23, kPeriod_s).has_value());  // the next reading is missing
  EXPECT_TRUE(rate_between_readings(window, 10, kPeriod_s).has_value());
  for (std::size_t k = 12; k < 15; ++k) window[k].observation.clipping.gyro = 2;
  // sample 12 is the first at or after this time
  EXPECT_FALSE(rate_between_readings(window, 10, kPeriod_s).has_value());
  for (AngularRateStreamKnot& knot : window) knot.repeats_reading = false, knot.repeated = {};
  EXPECT_FALSE(rate_between_readings(window, 6, kPeriod_s).has_value());  // each sample has a reading
}

// Interpolated forces along a line are correct at the middle of the sample's window, up to the error of the clock;
// logged forces are later by the reading's age and longer window.
TEST(InterpolatedRates, ForcesOnALineComeBackAtTheirOwnTime) {
  constexpr std::size_t kEach = 4;
  constexpr double kSlope_m_s3 = 10.0;
  std::vector<ImuSample> samples(400), all;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    samples[k].angular_velocity_rad_s = Vector3d(1.0 + 1e-3 * static_cast<double>(k), 0.0, 0.0);
    samples[k].specific_force_m_s2 = Vector3d(kSlope_m_s3 * kPeriod_s * (static_cast<double>(k) - 0.5), 0.0, 1.0);
  }
  EXPECT_TRUE(interpolated_forces(samples).empty());  // each sample has a reading
  all = samples;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    // taken half a sample before it is logged, at the middle of a window of half the period
    const double taken = static_cast<double>(k - k % kEach) - 0.5, middle = taken - 0.25 * kEach;
    samples[k].specific_force_m_s2.x() = kSlope_m_s3 * kPeriod_s * middle;
  }
  const std::vector<Vector3d> found = interpolated_forces(samples);
  ASSERT_EQ(found.size(), samples.size());
  for (std::size_t k = 2 * kEach; k + 2 * kEach < samples.size(); ++k) {
    const double truth = all[k].specific_force_m_s2.x();
    EXPECT_NEAR(found[k].x(), truth, 0.5 * kSlope_m_s3 * kPeriod_s) << k;
    EXPECT_GT(truth - samples[k].specific_force_m_s2.x(), 0.9 * kSlope_m_s3 * kPeriod_s) << k;
  }
}

/// Returns a tumble at 100 Hz whose gyro gives the mean over each `window` thousandths of a second.
TumbleRecording slow_gyro(std::uint64_t seed, std::size_t window) {
  constexpr std::size_t kFine = 10;
  TumbleOptions options;
  options.seed = options.mounting_seed = seed;
  options.rate_hz = 1000;
  options.gyro_rail_rad_s = 1e3;
  options.gyro_sigma_rad_s *= std::sqrt(10.0);
  options.accel_sigma_m_s2 *= std::sqrt(10.0);
  const TumbleRecording fine = make_tumble(options);
  const auto mean = [&](std::size_t end, std::size_t count, const auto& of) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = end - count; i < end; ++i) sum += of(i) / static_cast<double>(count);
    return sum;
  };
  TumbleRecording out;
  for (std::size_t end = 4 * kFine; end <= fine.samples.size(); end += kFine) {
    const std::size_t taken = end - (end - 3) % window;
    ImuSample sample = fine.samples[end - 1];
    sample.specific_force_m_s2 = mean(end, kFine, [&](std::size_t i) { return fine.samples[i].specific_force_m_s2; });
    sample.angular_velocity_rad_s =
        mean(taken, window, [&](std::size_t i) { return fine.samples[i].angular_velocity_rad_s; });
    out.samples.push_back(sample);
    out.truth.push_back(mean(end, kFine, [&](std::size_t i) { return fine.truth[i]; }));
  }
  return out;
}

/// Returns how late the rates of samples without a clipped axis are: least squares over the true acceleration.
double late_s(const TumbleRecording& recording, const std::vector<AngularRateState>& rates) {
  double product = 0.0, square = 0.0;
  for (std::size_t k = 1; k + 1 < rates.size(); ++k) {
    if (rates[k].source != AngularRateSource::measured) continue;
    const Vector3d change = (recording.truth[k + 1] - recording.truth[k - 1]) / (2.0 * kPeriod_s);
    product += change.dot(recording.truth[k] - rates[k].w_WI_I_rad_s);
    square += change.squaredNorm();
  }
  return product / square;
}

// The test averages over tumbles, because one dominant impact makes the remaining clock error of a single tumble early
// or late. The measured delay is 11.1 ms as read, 0.9 ms in batch and 2.1 ms live, because a stream detects repetitions
// only after 30 moving samples.
TEST(InterpolatedRates, BatchAndStreamAreInTime) {
  double read = 0.0, batch = 0.0, live = 0.0;
  constexpr double kTumbles = 8.0;
  for (std::uint64_t seed = 2; seed < 10; ++seed) {
    const TumbleRecording recording = slow_gyro(seed, 18);
    std::vector<AngularRateState> rates;
    AngularRateReport report;
    ASSERT_TRUE(AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>())
                    .estimate(recording.samples, rates, report)
                    .ok());
    EXPECT_NEAR(report.gyro_update_interval_s, 0.018, 2e-4);
    batch += late_s(recording, rates) / kTumbles;

    const AngularRateStream method(with_lever_arm<AngularRateStream::Params>());
    AngularRateStream::State state = method.start();
    std::optional<AngularRateState> one;
    rates.clear();
    for (const ImuSample& sample : recording.samples) {
      ASSERT_TRUE(method.push(sample, state, one).ok());
      if (one) rates.push_back(*one);
    }
    method.flush(state, rates);
    live += late_s(recording, rates) / kTumbles;
    for (std::size_t k = 0; k < rates.size(); ++k) rates[k].w_WI_I_rad_s = recording.samples[k].angular_velocity_rad_s;
    read += late_s(recording, rates) / kTumbles;
  }
  EXPECT_GT(read, 0.01);
  EXPECT_LT(std::abs(batch), 1.5e-3);
  EXPECT_LT(std::abs(live), 3e-3);
}

}  // namespace
}  // namespace tumble
