// SPDX-License-Identifier: BSD-3-Clause
// Tests the stream that distinguishes flight, contact and hand-held motion.
#include "tumble/attitude/detail/regime_stream.hpp"

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "estimator/attitude/hand_held_errors.hpp"
#include "estimator/attitude/hand_held_motion.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::clipped_errors;
using testing::HandHeldMotion;
using testing::HandHeldRecording;
using testing::quantile;

struct Joined {
  std::vector<AngularRateState> rates;
  std::vector<double> hand_held;  ///< hand-held share after each reported sample
  MotionRegimeStream::State state;
};

/// Middle is the state of a stream in the middle, and the number of rates reported so far.
struct Middle {
  std::size_t samples = 0;
  MotionRegimeStream::State state;
  std::size_t reported = 0;
};

MotionRegimeStream::Params at_its_hand() {
  MotionRegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = HandHeldMotion().lever_arm_m;
  return params;
}

/// Continues from `from`; stores in `middle` the state before sample number `middle`.
Joined go_on(const std::vector<ImuSample>& samples, const MotionRegimeStream::Params& params, const Middle& from,
             Middle* middle = nullptr) {
  const MotionRegimeStream stream(params);
  Joined out;
  out.state = from.state;
  std::optional<AngularRateState> rate;
  for (std::size_t k = from.samples; k < samples.size(); ++k) {
    if (middle != nullptr && k == middle->samples) {
      middle->state = out.state;
      middle->reported = out.rates.size();
    }
    EXPECT_TRUE(stream.push(samples[k], out.state, rate).ok());
    if (!rate) continue;
    out.rates.push_back(*rate);
    out.hand_held.push_back(out.state.probabilities.hand_held);
  }
  stream.flush(out.state, out.rates);
  EXPECT_EQ(from.reported + out.rates.size(), samples.size());
  return out;
}

Joined joined(const std::vector<ImuSample>& samples, const MotionRegimeStream::Params& params,
              Middle* middle = nullptr) {
  return go_on(samples, params, {0, MotionRegimeStream(params).start(), 0}, middle);
}

/// SlowlyBegun is the twirl of HandHeldMotion with a slow start: its own time runs at 0.3 for four seconds, then faster
/// up to 1 within two. Flags replace a saturation level that would have to be found first.
struct SlowlyBegun {
  HandHeldMotion motion;
  double speed(double t) const { return 0.3 + 0.7 * std::clamp(0.5 * (t - 4.0), 0.0, 1.0); }
  double time(double t) const {
    const double ramp = std::clamp(t - 4.0, 0.0, 2.0);
    return 0.3 * t + 0.175 * ramp * ramp + 0.7 * std::max(0.0, t - 6.0);
  }
  Eigen::Vector3d rate(double t) const { return speed(t) * motion.rate(time(t)); }
  Eigen::Vector3d angular_acceleration(double t) const { return (rate(t + 1e-5) - rate(t - 1e-5)) / 2e-5; }
  Eigen::Vector3d turning(double t, const Eigen::Vector3d& arm) const {
    return angular_acceleration(t).cross(arm) + rate(t).cross(rate(t).cross(arm));
  }
  HandHeldRecording record(double hz, double duration_s, double rail_rad_s) const {
    HandHeldRecording out;
    for (int k = 1; k <= static_cast<int>(hz * duration_s); ++k) {
      const double end = k / hz, t = end - 0.5 / hz;
      ImuSample sample;
      sample.time_ns = static_cast<TimeNs>(std::llround(end * 1e9));
      sample.angular_velocity_rad_s = rate(t);
      const Eigen::Vector3d up(0.0, 0.0, motion.gravity_m_s2);
      sample.specific_force_m_s2 =
          motion.attitude(time(t)).conjugate() * (motion.hand_acceleration(t) + up) + turning(t, motion.lever_arm_m);
      out.rate_rad_s.push_back(sample.angular_velocity_rad_s);
      ClipSigns signs;
      double& x = sample.angular_velocity_rad_s.x();
      if (std::abs(x) > rail_rad_s) {
        signs.gyro[0] = x > 0.0 ? 1 : -1;
        x = signs.gyro[0] * rail_rad_s;
        sample.device_clip_flags = kClipGyroX;
      }
      out.samples.push_back(sample);
      out.signs.push_back(signs);
    }
    return out;
  }
};

TEST(MotionRegimeStream, AHandIsDetected) {
  const HandHeldRecording recording = SlowlyBegun().record(100.0, 16.0, 7.3);
  const std::vector<ImuSample>& samples = recording.samples;
  Middle middle;
  middle.samples = 733;
  const Joined whole = joined(samples, at_its_hand(), &middle);
  EXPECT_GT(whole.state.regime_probability_sum.hand_held / static_cast<double>(whole.state.reported_sample_count), 0.9);
  EXPECT_GT(whole.state.combined_samples, 300u);
  const std::vector<double> errors = clipped_errors(recording, whole.rates, 2.0);
  std::printf("joined: %.3f / %.3f rad/s\n", quantile(errors, 0.5), quantile(errors, 0.9));
  EXPECT_LT(quantile(errors, 0.5), 0.6);
  // a copy of the state continues with identical bits
  const Joined rest = go_on(samples, at_its_hand(), middle);
  ASSERT_GT(rest.rates.size(), 800u);
  for (std::size_t k = 0; k < rest.rates.size(); ++k) {
    const AngularRateState& expected = whole.rates[middle.reported + k];
    ASSERT_EQ(expected.w_WI_I_rad_s, rest.rates[k].w_WI_I_rad_s) << k;
    ASSERT_EQ(expected.covariance_rad2_s2, rest.rates[k].covariance_rad2_s2) << k;
  }
}

/// The samples are as far apart as the time over which rates are differentiated; seconds since the clock's start would
/// be rounded differently for each start.
TEST(MotionRegimeStream, WhenTheClockStartedIsNothingToTheRates) {
  std::vector<ImuSample> samples = SlowlyBegun().record(100.0, 10.0, 7.3).samples;
  const Joined at_zero = joined(samples, at_its_hand());
  constexpr TimeNs kLater_ns = 1'000'000'000'000;
  for (ImuSample& sample : samples) sample.time_ns += kLater_ns;
  const Joined later = joined(samples, at_its_hand());
  ASSERT_EQ(later.rates.size(), at_zero.rates.size());
  for (std::size_t k = 0; k < later.rates.size(); ++k) {
    ASSERT_EQ(later.rates[k].time_ns, at_zero.rates[k].time_ns + kLater_ns);
    ASSERT_EQ(later.rates[k].w_WI_I_rad_s, at_zero.rates[k].w_WI_I_rad_s) << k;
    ASSERT_EQ(later.rates[k].covariance_rad2_s2, at_zero.rates[k].covariance_rad2_s2) << k;
  }
}

/// The stated IMU is 10 cm from the centre of mass; the lever arm's force could look like gravity if the angular
/// acceleration followed the force. The gyro reads this acceleration between the spins, so hand-held motion is
/// detected.
TEST(MotionRegimeStream, AHandIsKnownByAnImuFarFromTheCentreOfMass) {
  const HandHeldRecording recording = SlowlyBegun().record(100.0, 16.0, 7.3);
  MotionRegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = {-0.022, -0.085, 0.055};
  const Joined found = joined(recording.samples, params);
  double least = 1.0, within = 0.0, clipped = 0.0;
  for (std::size_t k = 0; k < found.rates.size(); ++k) {
    const bool late = seconds(found.rates[k].time_ns) > 5.0;
    if (late && k < found.hand_held.size()) least = std::min(least, found.hand_held[k]);
    if (!late || recording.signs[k].gyro[0] == 0) continue;
    clipped += 1.0;
    const double error = found.rates[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x();
    within += error * error < 9.0 * found.rates[k].covariance_rad2_s2(0, 0) ? 1.0 : 0.0;
  }
  std::printf("share of the hand: least %.3f; within 3 sigma %.4f\n", least, within / clipped);
  EXPECT_GT(least, 0.5);
  EXPECT_GE(within / clipped, 0.97);
}

/// Simulates a log at 240 Hz of an IMU that reads at 100 Hz: each reading two or three times, up to a reading's time
/// late.
HandHeldRecording said_again(const HandHeldRecording& own, const SlowlyBegun& motion) {
  HandHeldRecording out;
  for (std::size_t k = 0, from = 0; from + 1 < own.samples.size(); ++k) {
    const double t = static_cast<double>(k + 3) / 240.0;
    while (from + 1 < own.samples.size() && seconds(own.samples[from + 1].time_ns) <= t) ++from;
    out.samples.push_back(own.samples[from]);
    out.samples.back().time_ns = static_cast<TimeNs>(std::llround(1e9 * t));
    out.signs.push_back(own.signs[from]);
    out.rate_rad_s.push_back(motion.rate(t));
  }
  return out;
}

/// If repetitions are unknown, the stream has a median error of 0.37 rad/s, and 56 % of the errors are within three
/// deviations.
TEST(MotionRegimeStream, ReadingsThatTheLogSaysAgainCountOnce) {
  const SlowlyBegun motion;
  const HandHeldRecording recording = said_again(motion.record(100.0, 16.0, 7.3), motion);
  MotionRegimeStream::Params params = at_its_hand();
  params.rate.period_s = 1.0 / 240.0;
  const Joined found = joined(recording.samples, params);
  const std::vector<double> errors = clipped_errors(recording, found.rates, 2.0);
  double within = 0.0, count = 0.0;
  for (std::size_t k = 0; k < found.rates.size(); ++k) {
    if (seconds(found.rates[k].time_ns) < 2.0) continue;
    count += 1.0;
    const double error = found.rates[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x();
    within += error * error < 9.0 * found.rates[k].covariance_rad2_s2(0, 0) ? 1.0 : 0.0;
  }
  std::printf("said again: %.3f / %.3f rad/s, within 3 sigma %.4f\n", quantile(errors, 0.5), quantile(errors, 0.9),
              within / count);
  ASSERT_GT(errors.size(), 300u);
  EXPECT_LT(quantile(errors, 0.5), 0.3);
  EXPECT_GE(within / count, 0.98);
}

/// The motion reverses once a second with few readings in between, so it is one clipped segment; an unknown motion type
/// at first must not affect the rest. The flight model would be wrong by 10 rad/s.
TEST(MotionRegimeStream, AHandAtTheStartSaysNothingAboutTheRest) {
  HandHeldMotion motion;
  motion.spin_rad = 4.0;
  motion.spin_hz = motion.hand_hz = 1.0;
  const HandHeldRecording recording = record(motion, 100.0, 10.0, 7.0);
  const Joined found = joined(recording.samples, at_its_hand());
  const std::vector<double> errors = clipped_errors(recording, found.rates, 2.0);
  std::printf("one segment: %.3f / %.3f rad/s\n", quantile(errors, 0.5), quantile(errors, 0.9));
  EXPECT_LT(quantile(errors, 0.5), 1.5);
}

/// The body is thrown while it is assumed hand-held, and caught again: the probabilities follow within the lag, in both
/// directions.
TEST(MotionRegimeStream, ThrownAndCaughtAreSeen) {
  const SlowlyBegun motion;
  std::vector<ImuSample> samples = motion.record(100.0, 16.0, 7.3).samples;
  for (std::size_t k = 1000; k < 1080; ++k)  // only the force of the lever arm
    samples[k].specific_force_m_s2 = motion.turning(0.01 * (static_cast<double>(k) + 0.5), motion.motion.lever_arm_m);
  MotionRegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = HandHeldMotion().lever_arm_m;
  const MotionRegimeStream stream(params);
  MotionRegimeStream::State state = stream.start();
  std::optional<AngularRateState> rate;
  std::vector<double> hand_held;
  for (const ImuSample& sample : samples) {
    ASSERT_TRUE(stream.push(sample, state, rate).ok());
    if (rate) hand_held.push_back(state.probabilities.hand_held);
  }
  std::printf("carried: before %.3f, thrown %.3f, after %.3f\n", hand_held[995], hand_held[1060], hand_held[1400]);
  EXPECT_GT(hand_held[995], 0.9);
  EXPECT_LT(hand_held[1060], 0.1);
  EXPECT_GT(hand_held[1400], 0.9);
}

/// Returns the probability of hand-held motion after 0.3 s of a clipped flight, when `dropped` rig resets count at its
/// start.
double share_in_flight(std::uint64_t seed, double dropped) {
  TumbleOptions options;
  options.seed = options.mounting_seed = seed;
  options.gyro_rail_rad_s = 7.0;
  const TumbleRecording tumble = make_tumble(options);
  const auto begin = std::find(tumble.phase.begin(), tumble.phase.end(), Phase::flight) - tumble.phase.begin();
  MotionRegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = options.lever_arm_m;
  const MotionRegimeStream stream(params);
  MotionRegimeStream::State state = stream.start();
  std::optional<AngularRateState> rate;
  for (const ImuSample& sample : tumble.samples) {
    EXPECT_TRUE(stream.push(sample, state, rate).ok());
    if (state.reported_sample_count == static_cast<std::size_t>(begin) && rate) state.calibration_reset_rate += dropped;
    if (state.reported_sample_count == static_cast<std::size_t>(begin) + 30) break;
  }
  return state.probabilities.hand_held;
}

/// A throwing hand gives the rig a wrong calibration, which is reset step after step: at most 20 times in a lag. The
/// resets must not affect the following flight: the uncertainty is gone before the lag is over. The control is an
/// uncertainty that lasts.
TEST(MotionRegimeStream, AFlightIsSeenThoughThePushBeforeItBentTheRig) {
  for (const std::uint64_t seed : {5, 7}) {
    EXPECT_LT(share_in_flight(seed, 20.0), 0.02) << seed;
    EXPECT_GT(share_in_flight(seed, 1e6), 0.3) << seed;
  }
}

}  // namespace
}  // namespace tumble
