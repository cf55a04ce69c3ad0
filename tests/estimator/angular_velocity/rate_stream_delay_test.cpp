// SPDX-License-Identifier: BSD-3-Clause
// Tests a stream whose accelerometer is later than its gyro: the delay is estimated from impacts against closed forms
// and the batch, applied, saved, and not found where there is none.
#include "estimator/angular_velocity/streamed_rates.hpp"
#include "estimator/angular_velocity/tumble_recording.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {
namespace {

constexpr double kStrokePeriod_s = 0.01;

// Returns sums with an impact every tenth interval and an accelerometer `late` eighths of a sample late; the rotation
// follows the force.
ImpactDelayCorrelation struck_every_tenth(int late, int intervals, double between_m_s2 = 1.0) {
  ImpactDelayCorrelation out;
  for (int k = 0; k < intervals; ++k) {
    ImpactDelayCorrelation::DelayGrid force;
    const auto at = [&](double eighth) {
      const double since = std::fmod(8.0 * k + eighth + 800.0, 80.0);
      const double phase = std::min(since, 80.0 - since) / 8.0;  // samples since the nearest stroke
      return between_m_s2 + 100.0 * std::exp(-0.5 * phase * phase);
    };
    for (int i = 0; i < ImpactDelayCorrelation::kDelayCount; ++i)
      force[i] = at(i - ImpactDelayCorrelation::kDelayMax - late);
    out.add(3.0 * at(0.0), force);
  }
  return out;
}

// Delays the accelerometer by `samples` from sample `from` on; a negative number makes it early.
void delay_force(int samples, std::size_t from, TumbleRecording& recording) {
  const std::vector<ImuSample> in_time = recording.samples;
  const auto size = static_cast<std::ptrdiff_t>(in_time.size());
  for (auto k = static_cast<std::ptrdiff_t>(from); k < size; ++k) {
    const std::ptrdiff_t at = std::clamp<std::ptrdiff_t>(k - samples, 0, size - 1);
    recording.samples[static_cast<std::size_t>(k)].specific_force_m_s2 =
        in_time[static_cast<std::size_t>(at)].specific_force_m_s2;
  }
}

TumbleRecording long_late_tumble(std::uint64_t seed, int late) {
  TumbleOptions options;
  options.seed = options.mounting_seed = seed;
  options.flights = 30;
  options.speed_low_rad_s = 3.0;  // strokes that the gyro can measure
  options.speed_high_rad_s = 14.0;
  TumbleRecording out = make_tumble(options);
  delay_force(late, 0, out);
  return out;
}

AngularRateStream::Params looking(bool looks_for_it = true) {
  auto out = with_lever_arm<AngularRateStream::Params>();
  if (!looks_for_it) out.model.expert.error_priors.delay_uncalibrated_s = out.model.expert.error_priors.delay_s;
  return out;
}

TEST(ImpactDelayCorrelation, DetectAnExistingDelay) {
  for (const int late : {-20, -3, 0, 8, 13, 30}) {
    const TriadDelay told = struck_every_tenth(late, 200).estimate_delay(kStrokePeriod_s, kStrokePeriod_s);
    EXPECT_NEAR(told.delay_s, late * kStrokePeriod_s / 8.0, 1e-9) << late;
    EXPECT_DOUBLE_EQ(told.sigma_s, 0.15 * kStrokePeriod_s);
    EXPECT_NEAR(struck_every_tenth(late, 200).force_correlation_at(told.delay_s, kStrokePeriod_s), 1.0, 0.01);
  }
}

TEST(ImpactDelayCorrelation, DetectNothingInFewSamplesInAHandOrAtTheEnds) {
  EXPECT_EQ(struck_every_tenth(8, 29).estimate_delay(kStrokePeriod_s, kStrokePeriod_s).sigma_s, 0.0);
  EXPECT_EQ(struck_every_tenth(8, 200, 10.0).estimate_delay(kStrokePeriod_s, kStrokePeriod_s).sigma_s, 0.0)
      << "never without a force";
  EXPECT_EQ(struck_every_tenth(36, 200).estimate_delay(kStrokePeriod_s, kStrokePeriod_s).sigma_s, 0.0);
  // forgotten readings have less weight, for an equal delay
  ImpactDelayCorrelation half = struck_every_tenth(8, 200);
  half.decay_sums(0.5);
  EXPECT_NEAR(half.intervals, 100.0, 1e-12);
  EXPECT_NEAR(half.estimate_delay(kStrokePeriod_s, kStrokePeriod_s).delay_s, kStrokePeriod_s, 1e-9);
}

// Two Gaussians and their fractions are computed by hand.
TEST(AngularRateStreamDelay, OddsOfTheSheetAreThoseOfTwoGaussians) {
  const SensorErrorPriors sizes;
  const double sigma_s = 1.5e-3;
  for (const double delay_s : {0.0, 3e-3, 6e-3, 0.01}) {
    const auto density = [&](double size) {
      const double variance = size * size + sigma_s * sigma_s;
      return std::exp(-0.5 * delay_s * delay_s / variance) / std::sqrt(variance);
    };
    const double odds = 0.7 / 0.3 * density(sizes.delay_s) / density(sizes.delay_uncalibrated_s);
    EXPECT_NEAR(SensorErrorUncertainty(sizes, 0.3).data_sheet_odds(delay_s, sigma_s), odds, 1e-9 * odds) << delay_s;
  }
  EXPECT_GT(SensorErrorUncertainty(sizes, 0.3).data_sheet_odds(4.5e-3, sigma_s), 0.05);
  EXPECT_LT(SensorErrorUncertainty(sizes, 0.3).data_sheet_odds(6e-3, sigma_s), 0.05);
}

// With one unknown, readings have weight 0.03, and impacts are entered with full weight.
TEST(AngularRateStreamDelay, AFurtherDelayIsTheWeightedMean) {
  SensorErrorInformation told;
  const double of_readings_s = 2e-4, of_strokes_s = 1.5e-3, reach_s = 0.04;
  const double readings = SensorErrorUncertainty::kSensorErrorEvidenceWeight / (of_readings_s * of_readings_s),
               impacts = 1.0 / (of_strokes_s * of_strokes_s);
  told.information(SensorErrors::kDelay, SensorErrors::kDelay) =
      (readings + impacts) / SensorErrorUncertainty::kSensorErrorEvidenceWeight;
  told.gradient[SensorErrors::kDelay] =
      (readings * 1e-3 - impacts * 2e-3) / SensorErrorUncertainty::kSensorErrorEvidenceWeight;
  const double expected = (readings * 1e-3 - impacts * 2e-3) / (readings + impacts + 1.0 / (reach_s * reach_s));
  EXPECT_NEAR(SensorErrorUncertainty({}, 0.3).delay_correction_s(told, reach_s), expected, 1e-12);
  told.information(SensorErrors::kDelay, SensorErrors::kDelay) = -1e12;
  EXPECT_EQ(SensorErrorUncertainty({}, 0.3).delay_correction_s(told, reach_s), 0.0);
}

TEST(AngularRateStreamDelay, IsThatOfTheBatch) {
  int found = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const TumbleRecording late = long_late_tumble(seed, 1);
    const AngularRateStream method(looking());
    AngularRateStream::State state = method.start();
    (void)streamed_rates(method, late.samples, state);
    if (!state.sensor_errors.front().accel_delay_state.delay_found) continue;
    ++found;
    const KnownSensorErrors errors = method.sensor_errors_except_biases(state);
    const double sigma_s = std::sqrt(errors.covariance(SensorErrors::kDelay, SensorErrors::kDelay));
    std::vector<AngularRateState> states;
    AngularRateReport report;
    ASSERT_TRUE(
        AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(late.samples, states, report).ok());
    EXPECT_NEAR(errors.errors.accel_delay_s, 0.01, 3.0 * sigma_s) << seed;
    EXPECT_NEAR(errors.errors.accel_delay_s, report.sensor_errors.errors.accel_delay_s, 3.0 * sigma_s) << seed;
    EXPECT_LT(sigma_s, 2e-3);
    EXPECT_EQ(state.sensor_errors.front().posterior.uncalibrated_probability, 1.0);
  }
  EXPECT_GE(found, 4);
}

// Negative controls: synchronous sensors, and a device whose data sheet is accepted.
TEST(AngularRateStreamDelay, IsNotFoundWhereThereIsNone) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const AngularRateStream method(looking()), believes(looking(false));
    AngularRateStream::State state = method.start();
    std::optional<AngularRateState> one;
    for (const ImuSample& sample : long_late_tumble(seed, 0).samples) {
      ASSERT_TRUE(method.push(sample, state, one).ok());
      ASSERT_FALSE(state.sensor_errors.front().accel_delay_state.delay_found) << seed;
    }
    EXPECT_EQ(method.sensor_errors_except_biases(state).errors.accel_delay_s, 0.0);
    AngularRateStream::State other = believes.start();
    (void)streamed_rates(believes, long_late_tumble(seed, 1).samples, other);
    EXPECT_FALSE(other.sensor_errors.front().accel_delay_state.delay_found) << seed;
  }
}

// The clock changes: late at first, and early from the middle on. At the end, the stream uses the last delay, or none.
TEST(AngularRateStreamDelay, OneThatChangesItsSignIsFollowedOrDropped) {
  int dropped = 0;
  for (const std::uint64_t seed : {2u, 3u, 5u}) {
    const TumbleRecording late = long_late_tumble(seed, 1), early = long_late_tumble(seed, -1);
    const AngularRateStream method(looking());
    AngularRateStream::State state = method.start();
    (void)streamed_rates(method, late.samples, state);
    const bool found = state.sensor_errors.front().accel_delay_state.delay_found;
    std::optional<AngularRateState> one;
    for (int again = 1; again <= 4; ++again) {
      for (ImuSample sample : early.samples) {
        sample.time_ns += again * late.samples.back().time_ns;
        ASSERT_TRUE(method.push(sample, state, one).ok());
      }
    }
    EXPECT_LT(state.sensor_errors.front().accel_delay_state.applied_delay_s, 5e-3) << seed;
    dropped += found ? 1 : 0;
  }
  EXPECT_GE(dropped, 2);
}

// In the run after the delay was found, the errors are those of a synchronous accelerometer.
TEST(AngularRateStreamDelay, OnceFoundTheNextRunIsAsGoodAsInTime) {
  double unknown = 0.0, carried = 0.0, in_time = 0.0;
  std::size_t inside = 0, all = 0, found = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const TumbleRecording second = long_late_tumble(seed + 20, 1), clean = long_late_tumble(seed + 20, 0);
    const AngularRateStream method(looking());
    AngularRateStream::State state = method.start();
    (void)streamed_rates(method, long_late_tumble(seed, 1).samples, state);
    if (!state.sensor_errors.front().accel_delay_state.delay_found) continue;
    ++found;
    auto next = looking();
    next.calibrated_errors = std::make_shared<KnownSensorErrors>(method.sensor_errors_except_biases(state));
    const auto run = [](const AngularRateStream::Params& params, const TumbleRecording& recording) {
      const AngularRateStream stream(params);
      AngularRateStream::State fresh = stream.start();
      return streamed_rates(stream, recording.samples, fresh);
    };
    const std::vector<AngularRateState> of_next = run(next, second);
    carried += clipped_errors(second, rates_of(of_next), 10.49).median;
    unknown += clipped_errors(second, rates_of(run(looking(false), second)), 10.49).median;
    in_time += clipped_errors(clean, rates_of(run(looking(), clean)), 10.49).median;
    for (std::size_t k = 0; k < of_next.size(); ++k) {
      for (int j = 0; j < 3; ++j) {
        if ((of_next[k].clipped_axes >> j & 1) == 0) continue;
        const double error = of_next[k].w_WI_I_rad_s[j] - second.truth[k][j];
        inside += error * error <= 9.0 * of_next[k].covariance_rad2_s2(j, j);
        ++all;
      }
    }
  }
  EXPECT_GE(found, 5u);
  ASSERT_GT(all, 500u);
  EXPECT_LT(carried, 2.0 * in_time);
  EXPECT_GT(unknown, 2.0 * carried);
  EXPECT_GE(static_cast<double>(inside), 0.97 * static_cast<double>(all));
}

// The stream is split around the sample at which the delay is found, and long after; a state with another delay
// differs.
TEST(AngularRateStreamDelay, SplittingAnywhereChangesNothing) {
  const std::vector<ImuSample> samples = long_late_tumble(3, 1).samples;
  const AngularRateStream method(looking());
  AngularRateStream::State state = method.start();
  std::optional<AngularRateState> one;
  std::size_t found = 0;  // the sample at which the stream finds the delay
  for (std::size_t k = 0; k < samples.size() && found == 0; ++k) {
    ASSERT_TRUE(method.push(samples[k], state, one).ok());
    if (state.sensor_errors.front().accel_delay_state.delay_found) found = k;
  }
  ASSERT_GT(found, 30u);
  expect_same_rates_if_split(looking(), samples, {found - 1, found, found + 1, found + 2, found + 300});
}

// A stated delay applies from the start: forces are paired with the rates at their own times, also in the newest
// sample. A late gyro reports the rate of a later time.
TEST(AngularRateStreamDelay, AStatedOneIsTakenFromTheStart) {
  for (const int late : {2, -2}) {
    double stated = 0.0, ignored = 0.0;
    for (const std::uint64_t seed : {2u, 3u, 5u}) {
      TumbleRecording recording = long_late_tumble(seed, 0);
      if (late > 0) {
        delay_force(late, 0, recording);
      } else {  // readings of the gyro are late
        const std::vector<ImuSample> in_time = recording.samples;
        for (std::size_t k = 2; k < in_time.size(); ++k)
          recording.samples[k].angular_velocity_rad_s = in_time[k - 2].angular_velocity_rad_s;
      }
      for (const bool tells : {true, false}) {
        AngularRateStream::Params params = looking(false);
        if (tells) params.model.errors.accel_delay_s = late * kStrokePeriod_s;
        const AngularRateStream method(params);
        AngularRateStream::State state = method.start();
        (tells ? stated : ignored) +=
            clipped_errors(recording, rates_of(streamed_rates(method, recording.samples, state)), 10.49).median;
      }
    }
    EXPECT_LT(stated, 0.4 * ignored) << late;
  }
}

}  // namespace
}  // namespace tumble
