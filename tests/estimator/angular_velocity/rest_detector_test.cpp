// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rest_detector.hpp"

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/common/status.hpp"

namespace tumble {
namespace {

constexpr TimeNs kPeriodNs = 10'000'000;

// stationary, with a bias and the noise of an MTi-30 at 100 Hz
std::vector<ImuSample> standing(std::size_t count, std::uint64_t seed) {
  oracles::Gaussian noise(seed);
  std::vector<ImuSample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    samples[k].time_ns = static_cast<TimeNs>(k) * kPeriodNs;
    for (int j = 0; j < 3; ++j) {
      samples[k].angular_velocity_rad_s[j] = 0.01 * (j - 1) + 0.0052 * noise();
      samples[k].specific_force_m_s2[j] = (j == 2 ? 9.8 : 0.3) + 0.006 * noise();
    }
  }
  return samples;
}

std::ptrdiff_t resting(const std::vector<ImuSample>& samples) {
  const std::vector<bool> found = RestDetector({}).find(samples);
  return std::count(found.begin(), found.end(), true);
}

TEST(RestDetector, FindsAStandstillFromItsFirstSample) {
  // a reading exceeds the limit of 0.03 at 5.8 deviations: once in 1e8 readings
  EXPECT_EQ(resting(standing(200, 1)), 200);
}

// The noise of a reading grows with the sample rate: at 8 kHz it is 0.047 rad/s, beyond the spread of 0.03.
TEST(RestDetector, AFastImuRestsToo) {
  for (const int rate_hz : {250, 1000, 2000, 8000}) {
    const double louder = std::sqrt(rate_hz / 100.0);
    std::vector<ImuSample> samples = standing(static_cast<std::size_t>(2 * rate_hz), 4);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      ImuSample& sample = samples[k];
      sample.time_ns = static_cast<TimeNs>(k + 1) * 1'000'000'000 / rate_hz;
      for (int j = 0; j < 3; ++j) {
        sample.angular_velocity_rad_s[j] =
            0.01 * (j - 1) + louder * (sample.angular_velocity_rad_s[j] - 0.01 * (j - 1));
      }
    }
    // the first sample is a reading on its own, with the noise of one
    EXPECT_GE(resting(samples), static_cast<std::ptrdiff_t>(samples.size()) - 1) << rate_hz;
    // a slow turn is no rest, at any sample rate
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double t_s = seconds(samples[k].time_ns);
      samples[k].angular_velocity_rad_s.x() += 0.3 * t_s;
      samples[k].specific_force_m_s2.y() += 9.8 * std::sin(0.15 * t_s * t_s);
    }
    EXPECT_LT(resting(samples), static_cast<std::ptrdiff_t>(samples.size() / 2)) << rate_hz;
  }
}

TEST(RestDetector, ShorterThanItsLeastIsNoRest) {
  EXPECT_EQ(resting(standing(40, 2)), 0);
  EXPECT_EQ(resting(standing(42, 2)), 42);
}

TEST(RestDetector, MotionIsNoRest) {
  std::vector<ImuSample> turning = standing(200, 3);
  for (ImuSample& sample : turning) sample.angular_velocity_rad_s[0] += 0.2;
  EXPECT_EQ(resting(turning), 0) << "a steady turn";
  std::vector<ImuSample> tilting = standing(200, 3);
  for (std::size_t k = 0; k < tilting.size(); ++k) tilting[k].specific_force_m_s2[0] += 0.01 * static_cast<double>(k);
  EXPECT_EQ(resting(tilting), 0) << "1 m/s^2 a second: gravity turns by 0.1 rad/s";
  std::vector<ImuSample> flying = standing(200, 3);
  for (ImuSample& sample : flying) sample.specific_force_m_s2.setZero();
  EXPECT_EQ(resting(flying), 0) << "weightless";
}

TEST(RestDetector, ARestEndsWithItsMotion) {
  std::vector<ImuSample> samples = standing(200, 4);
  for (std::size_t k = 100; k < 200; ++k) samples[k].angular_velocity_rad_s[1] += 1.0;
  EXPECT_EQ(resting(samples), 100);
}

// The rate limit applies relative to a known bias, so the same turn counts as rest if it is known as a bias.
TEST(RestDetector, AKnownBiasIsNoTurn) {
  const Eigen::Vector3d bias_rad_s(0.0, 0.0, 0.2);
  std::vector<ImuSample> samples = standing(100, 5);
  for (ImuSample& sample : samples) sample.angular_velocity_rad_s += bias_rad_s;
  const RestDetector detector({});
  RestDetector::State known, unknown;
  for (const ImuSample& sample : samples) {
    detector.detect_stationary(sample, known, bias_rad_s);
    detector.detect_stationary(sample, unknown);
  }
  EXPECT_TRUE(known.is_stationary);
  EXPECT_FALSE(unknown.is_stationary);
  // noise of a mean over a hundred readings, 0.0052 each: five deviations
  EXPECT_LT((known.mean_rate_rad_s() - bias_rad_s - Eigen::Vector3d(-0.01, 0.0, 0.01)).cwiseAbs().maxCoeff(), 0.0026);
}

// A run with unlimited memory ends repeatedly during a drift; with a short memory it continues, and its mean is the
// current bias.
TEST(RestDetector, AMeanThatForgetsFollowsABiasThatDrifts) {
  constexpr double kDrift_rad_s2 = 0.002;
  constexpr int kCount = 3000;
  const auto drifting = [](double memory_s) {
    const RestDetector detector({.caller_settings = {.memory_s = memory_s}});
    RestDetector::State state;
    std::vector<ImuSample> samples = standing(kCount, 6);
    for (ImuSample& sample : samples) {
      sample.angular_velocity_rad_s.y() += -0.03 + kDrift_rad_s2 * seconds(sample.time_ns);
      detector.detect_stationary(sample, state);
    }
    return state;
  };
  EXPECT_EQ(drifting(1.0).first_ns, 0);
  EXPECT_GT(drifting(600.0).first_ns, 0);
  // the mean lags by the memory, 0.002 rad/s; noise of a hundred readings
  EXPECT_NEAR(drifting(1.0).mean_rate_rad_s().y(), -0.03 + kDrift_rad_s2 * 29.0, 0.0026);
}

// Means that the caller has averaged count as readings, weighted by their length.
TEST(RestDetector, TakesMeans) {
  constexpr TimeNs kNode_ns = 20'000'000;
  const RestDetector detector({.rest_s = 0.4, .caller_settings = {.reading_s = 1.0}});
  RestDetector::State state;
  const auto take = [&](double rate_rad_s, int k) {
    return detector.detect_stationary_from_mean({rate_rad_s, 0.0, 0.0}, {0.0, 0.0, 9.8}, k * kNode_ns,
                                                (k + 1) * kNode_ns, Eigen::Vector3d::Zero(), state);
  };
  for (int k = 0; k < 19; ++k) EXPECT_FALSE(take(0.01, k)) << k;
  EXPECT_TRUE(take(0.01, 19)) << "0.4 s";
  EXPECT_EQ(state.small_rate_since_ns, 400'000'000);
  EXPECT_FALSE(take(0.045, 20)) << "beyond the spread, below the largest";
  EXPECT_EQ(state.small_rate_since_ns, kNode_ns) << "a run of its own";
  EXPECT_FALSE(take(0.5, 21));
  EXPECT_EQ(state.small_rate_since_ns, 0);
}

TEST(RestDetector, ForceBeyondGravityIsNoRest) {
  std::vector<ImuSample> samples = standing(100, 7);
  const auto rests = [&](double force_max_m_s2) {
    const std::vector<bool> found = RestDetector({.caller_settings = {.force_max_m_s2 = force_max_m_s2}}).find(samples);
    return std::count(found.begin(), found.end(), true);
  };
  EXPECT_EQ(rests(10.3), 100);
  for (ImuSample& sample : samples) sample.specific_force_m_s2.z() += 0.6;  // a constant acceleration
  EXPECT_EQ(rests(10.3), 0);
}

TEST(RestDetector, RefusesParametersOutOfBounds) {
  RestDetector::Params params;
  params.rest_s = -1.0;
  EXPECT_THROW((RestDetector(params)), InvalidParams);
  params = {};
  params.force_spread_m_s2 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((RestDetector(params)), InvalidParams);
}

TEST(AngularRateSmoother, StandstillDeterminesTheBias) {
  std::vector<AngularRateState> out;
  AngularRateReport report;
  ASSERT_TRUE(
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(standing(300, 5), out, report).ok());
  // 300 samples of noise 0.0052 and tremor 0.01: a deviation of 0.0007, and 0.4 % of the way to the prior
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(report.calibration.constants.gyro_bias_rad_s[j], 0.01 * (j - 1), 0.002) << j;
}

}  // namespace
}  // namespace tumble
