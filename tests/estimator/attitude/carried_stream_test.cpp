// SPDX-License-Identifier: BSD-3-Clause
// The streams of carried bodies against motions in closed form and against the batch.
#include "tumble/attitude/carried_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "estimator/attitude/carried_motion.hpp"
#include "tumble/attitude/regime_stream.hpp"

namespace tumble {
namespace {

using testing::CarriedMotion;
using testing::CarriedRecording;

double quantile(std::vector<double> values, double share) {
  EXPECT_FALSE(values.empty());
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<RateState> stream(const CarriedRecording& recording, const CarriedStream::Params& params,
                              std::size_t split = 0) {
  const CarriedStream stream(params);
  CarriedStream::State state = stream.start();
  std::vector<RateState> out;
  std::optional<RateState> rate;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    ClippedElements known;
    known.signs = std::span(recording.signs).subspan(k, 1);
    if (k == split && k > 0) {
      const CarriedStream::State carried_over = state;
      state = stream.start();
      state = carried_over;
    }
    const Status status = stream.push(recording.samples[k], known, state, rate);
    EXPECT_TRUE(status.ok()) << status.message();
    if (rate) out.push_back(*rate);
  }
  EXPECT_EQ(state.failures, 0u);
  stream.flush(state, out);
  EXPECT_EQ(out.size(), recording.samples.size());
  return out;
}

std::vector<double> clipped_errors(const CarriedRecording& recording, const std::vector<RateState>& rates,
                                   double from_s) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    EXPECT_EQ(rates[k].time_ns, recording.samples[k].time_ns);
    if (recording.signs[k].gyro[0] == 0 || seconds(rates[k].time_ns) < from_s) continue;
    out.push_back((rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
  }
  return out;
}

TEST(CarriedStream, AStateThatItDidNotLeaveIsRefused) {
  const CarriedRecording recording = testing::record({}, 100.0, 3.0, 7.3);
  const CarriedStream method(CarriedStream::Params{});
  EXPECT_TRUE(method.check_state(method.start()).ok());
  CarriedStream::State left = method.start();
  std::optional<RateState> rate;
  for (std::size_t k = 0; k < 150; ++k) {
    ClippedElements known;
    known.signs = std::span(recording.signs).subspan(k, 1);
    ASSERT_TRUE(method.push(recording.samples[k], known, left, rate).ok());
    ASSERT_TRUE(method.check_state(left).ok()) << k;
  }
  const auto refused = [&](auto&& change) {
    CarriedStream::State made_up = left;
    change(made_up);
    return !method.check_state(made_up).ok();
  };
  EXPECT_TRUE(refused([](auto& s) { s.samples = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s = {}, s.first_node = std::numeric_limits<std::int64_t>::min(); }));
  EXPECT_TRUE(refused([](auto& s) { s.first_node = std::numeric_limits<std::int64_t>::max(); }));
  EXPECT_TRUE(refused([](auto& s) { s.window.pop_back(); }));
  EXPECT_TRUE(refused([](auto& s) { s.first_node -= 1000; }));
  EXPECT_TRUE(refused([](auto& s) { s.start_ns = std::numeric_limits<std::int64_t>::min(); }));
  EXPECT_TRUE(refused([](auto& s) { s.readings.back().centre_s += 1e3; }));
  // of last sample and first node alike, so that the window's size is right
  EXPECT_TRUE(refused([](auto& s) {
    for (CarriedStream::Reading& reading : s.readings) reading.node += 1000;
    s.first_node += 1000;
  }));
  EXPECT_TRUE(refused([](auto& s) { std::swap(s.readings[0].node, s.readings.back().node); }));
}

/// With one and a half seconds of lag the stream knows nearly what the batch knows, once it has found its attitude and
/// constants.
TEST(CarriedStream, IsTheBatchOnALongLag) {
  const CarriedRecording recording = testing::record({}, 100.0, 9.0, 7.3);
  CarriedStream::Params params;
  params.lag_s = 1.5;
  params.window_s = 1.8;
  params.body.hand_follow = 0.0;  // the one thing in which the two differ by design
  const std::vector<RateState> live = stream(recording, params);
  std::vector<RateState> batch;
  std::vector<AttitudeState> attitudes;
  CarriedSmoother::Report report;
  ClippedElements clipped;
  clipped.signs = recording.signs;
  ASSERT_TRUE(CarriedSmoother(params.body).estimate(recording.samples, clipped, batch, attitudes, report).ok());
  std::vector<double> apart, widths;
  for (std::size_t k = 0; k < live.size(); ++k) {
    if (recording.signs[k].gyro[0] == 0 || seconds(live[k].time_ns) < 4.0) continue;
    apart.push_back((live[k].w_WI_I_rad_s - batch[k].w_WI_I_rad_s).norm());
    widths.push_back(std::sqrt(live[k].covariance_rad2_s2(0, 0) / batch[k].covariance_rad2_s2(0, 0)));
  }
  std::printf("apart %.4f (99 %%: %.4f) rad/s, deviations %.3f times\n", quantile(apart, 0.5), quantile(apart, 0.99),
              quantile(widths, 0.5));
  EXPECT_LT(quantile(apart, 0.5), 0.02);
  EXPECT_LT(quantile(apart, 0.99), 0.1);
  EXPECT_NEAR(quantile(widths, 0.5), 1.0, 0.05);
}

TEST(CarriedStream, RecoversATwirlAtItsLag) {
  const CarriedRecording recording = testing::record({}, 100.0, 20.0, 7.3);
  const std::vector<RateState> live = stream(recording, {});
  std::vector<double> raw;
  std::size_t within = 0;
  for (std::size_t k = 0; k < live.size(); ++k) {
    if (recording.signs[k].gyro[0] == 0) continue;
    raw.push_back((recording.samples[k].angular_velocity_rad_s - recording.rate_rad_s[k]).norm());
    const double error = std::abs(live[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x());
    within += error < 3.0 * std::sqrt(live[k].covariance_rad2_s2(0, 0)) ? 1u : 0u;
    EXPECT_NE(live[k].source, RateSource::measured);
  }
  const std::vector<double> errors = clipped_errors(recording, live, 0.0);
  const double share = static_cast<double>(within) / static_cast<double>(errors.size());
  std::printf("raw %.3f, live %.3f / %.3f, within 3 sigma %.4f\n", quantile(raw, 0.5), quantile(errors, 0.5),
              quantile(errors, 0.9), share);
  ASSERT_GT(errors.size(), 500u);
  EXPECT_LT(quantile(errors, 0.5), 0.2 * quantile(raw, 0.5));
  EXPECT_GE(share, 0.97);
}

/// The lag is counted in samples of the period that was stated: where they come sparser, nodes leave the window before
/// their samples are old enough, and none may be lost for it.
TEST(CarriedStream, GivesEachRateWhereSamplesComeSparserThanIsSaid) {
  for (const double hz : {30.0, 20.0, 12.0}) {
    const CarriedRecording recording = testing::record({.spin_hz = 0.45}, hz, 20.0, 5.0);
    const CarriedStream::Params params;
    ASSERT_GT(params.lag_s / params.period_s, hz * params.window_s);  // a sample's lag is longer than the window
    const std::vector<RateState> live = stream(recording, params);    // one for each sample
    std::vector<double> raw;
    for (std::size_t k = 0; k < live.size(); ++k) {
      EXPECT_GT(live[k].covariance_rad2_s2.diagonal().minCoeff(), 0.0) << hz << " Hz, " << k;
      if (recording.signs[k].gyro[0] == 0) continue;
      raw.push_back((recording.samples[k].angular_velocity_rad_s - recording.rate_rad_s[k]).norm());
    }
    const std::vector<double> errors = clipped_errors(recording, live, 0.0);
    std::printf("%.0f Hz: raw %.3f, live %.3f\n", hz, quantile(raw, 0.5), quantile(errors, 0.5));
    EXPECT_LT(quantile(errors, 0.5), 0.5 * quantile(raw, 0.5)) << hz;
    const std::vector<RateState> parts = stream(recording, params, 101);
    for (std::size_t k = 0; k < live.size(); ++k) ASSERT_EQ(live[k].w_WI_I_rad_s, parts[k].w_WI_I_rad_s) << k;
  }
}

/// Readings that have wrapped over the rail say nothing; taken for free ones they would say the contrary.
TEST(CarriedStream, ReadingsThatWrapSayNothing) {
  const CarriedRecording clipped = testing::record({}, 100.0, 12.0, 7.3);
  const CarriedRecording wrapped = testing::with_wraps(clipped, ClipSigns::kVoid);
  const CarriedRecording believed = testing::with_wraps(clipped, 0);
  const auto median = [](const CarriedRecording& recording, const std::vector<RateState>& rates) {
    std::vector<double> errors;
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if (std::abs(recording.rate_rad_s[k].x()) <= 7.3) continue;
      errors.push_back((rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
    }
    return quantile(errors, 0.5);
  };
  const std::vector<RateState> live = stream(wrapped, {});
  for (std::size_t k = 0; k < live.size(); ++k) {
    if (wrapped.signs[k].gyro[0] == 0) continue;
    EXPECT_NE(live[k].source, RateSource::measured) << k;
    EXPECT_EQ(live[k].clipped_axes, 1) << k;
  }
  const double all = median(clipped, stream(clipped, {})), without = median(wrapped, live);
  const double free = median(believed, stream(believed, {}));
  std::printf("clipped %.3f, a third of them wrapped %.3f, believed %.3f\n", all, without, free);
  EXPECT_LT(without, 1.3 * all);
  EXPECT_GT(free, 5.0 * all);
}

TEST(CarriedStream, SplitsAnywhereToTheBit) {
  for (const double hz : {100.0, 500.0}) {
    const CarriedRecording recording = testing::record({}, hz, 2.0, 7.3);
    CarriedStream::Params params;
    params.period_s = 1.0 / hz;
    const std::vector<RateState> whole = stream(recording, params);
    for (const std::size_t split : {1u, 77u, 161u}) {
      const std::vector<RateState> parts = stream(recording, params, split);
      for (std::size_t k = 0; k < whole.size(); ++k) {
        ASSERT_EQ(whole[k].w_WI_I_rad_s, parts[k].w_WI_I_rad_s) << hz << " Hz, " << k;
        ASSERT_EQ(whole[k].covariance_rad2_s2, parts[k].covariance_rad2_s2) << hz << " Hz, " << k;
      }
    }
  }
}

TEST(CarriedStream, StatesACovarianceWithEachRate) {
  for (const double hz : {100.0, 200.0, 500.0}) {
    CarriedStream::Params params;
    params.period_s = 1.0 / hz;
    const std::vector<RateState> rates = stream(testing::record({}, hz, 2.0, 7.3), params);
    ASSERT_FALSE(rates.empty());
    for (std::size_t k = 0; k < rates.size(); ++k)
      ASSERT_GT(rates[k].covariance_rad2_s2.diagonal().minCoeff(), 0.0) << hz << " Hz, " << k;
  }
}

TEST(CarriedStream, RefusesBadInputAndKeepsItsState) {
  const CarriedRecording recording = testing::record({}, 100.0, 1.0, 7.3);
  const CarriedStream stream({});
  CarriedStream::State state = stream.start();
  std::optional<RateState> rate;
  ClippedElements known;
  for (std::size_t k = 0; k < 50; ++k) {
    known.signs = std::span(recording.signs).subspan(k, 1);
    ASSERT_TRUE(stream.push(recording.samples[k], known, state, rate).ok());
  }
  const auto trouble = [&](ImuSample sample, const ClippedElements& with) {
    const std::size_t before = state.samples;
    const Status status = stream.push(sample, with, state, rate);
    EXPECT_EQ(state.samples, before + (status.ok() ? 1u : 0u));
    EXPECT_TRUE(status.ok() || !rate);
    return status.trouble;
  };
  ImuSample bad = recording.samples[50];
  bad.specific_force_m_s2.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(trouble(bad, known), Trouble::non_finite);
  EXPECT_EQ(trouble(recording.samples[49], known), Trouble::time_order);
  bad = recording.samples[50];
  bad.time_ns += 3'000'000'000;
  EXPECT_EQ(trouble(bad, known), Trouble::gap);
  EXPECT_EQ(trouble(recording.samples[50], {}), Trouble::out_of_range);
  ClippedElements flat = known;
  flat.rows.setZero();
  EXPECT_EQ(trouble(recording.samples[50], flat), Trouble::degenerate);
  EXPECT_EQ(trouble(recording.samples[50], known), Trouble::none);
  // a drop-out longer than the window, and on
  bad = recording.samples[60];
  bad.time_ns += 800'000'000;
  EXPECT_EQ(trouble(bad, known), Trouble::none);
  CarriedStream::Params params;
  params.window_s = params.lag_s;
  EXPECT_THROW(CarriedStream{params}, InvalidParams);
  params = {};
  params.period_s = 0.0;
  EXPECT_THROW(CarriedStream{params}, InvalidParams);
  params = {};
  params.body.node_s = 0.0;
  EXPECT_THROW(CarriedStream{params}, InvalidParams);
}

struct Joined {
  std::vector<RateState> rates;
  std::vector<double> carried;  ///< share, after each sample given out
  RegimeStream::State state;
};

RegimeStream::Params at_its_hand() {
  RegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = CarriedMotion().lever_arm_m;
  return params;
}

Joined joined(const std::vector<ImuSample>& samples, const RegimeStream::Params& params, std::size_t split = 0) {
  const RegimeStream stream(params);
  Joined out;
  out.state = stream.start();
  std::optional<RateState> rate;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k == split && k > 0) {
      const RegimeStream::State carried_over = out.state;
      out.state = stream.start();
      out.state = carried_over;
    }
    EXPECT_TRUE(stream.push(samples[k], out.state, rate).ok());
    if (!rate) continue;
    out.rates.push_back(*rate);
    out.carried.push_back(out.state.shares.carried);
  }
  stream.flush(out.state, out.rates);
  EXPECT_EQ(out.rates.size(), samples.size());
  return out;
}

/// The twirl of CarriedMotion taken up slowly: its own time runs at 0.3 for four seconds, then ever faster to 1 within
/// two. Flags instead of a rail that has to be found first.
struct SlowlyBegun {
  CarriedMotion motion;
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
  CarriedRecording record(double hz, double duration_s, double rail_rad_s) const {
    CarriedRecording out;
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

TEST(RegimeStream, AHandIsKnownAndBelieved) {
  const CarriedRecording recording = SlowlyBegun().record(100.0, 16.0, 7.3);
  const std::vector<ImuSample>& samples = recording.samples;
  const Joined whole = joined(samples, at_its_hand());
  EXPECT_GT(whole.state.sum.carried / static_cast<double>(whole.state.given), 0.9);
  EXPECT_GT(whole.state.joined, 300u);
  const std::vector<double> errors = clipped_errors(recording, whole.rates, 2.0);
  std::printf("joined: %.3f / %.3f rad/s\n", quantile(errors, 0.5), quantile(errors, 0.9));
  EXPECT_LT(quantile(errors, 0.5), 0.6);
  const Joined parts = joined(samples, at_its_hand(), 733);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_EQ(whole.rates[k].w_WI_I_rad_s, parts.rates[k].w_WI_I_rad_s) << k;
    ASSERT_EQ(whole.rates[k].covariance_rad2_s2, parts.rates[k].covariance_rad2_s2) << k;
  }
}

/// The rig says that the IMU is 10 cm from the centre of mass: the lever arm's force could pass for gravity, if the
/// angular acceleration were free to follow the force. The gyro reads it between the spins, and so the hand is known.
TEST(RegimeStream, AHandIsKnownByAnImuFarFromTheCentreOfMass) {
  const CarriedRecording recording = SlowlyBegun().record(100.0, 16.0, 7.3);
  RegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = {-0.022, -0.085, 0.055};
  const Joined found = joined(recording.samples, params);
  double least = 1.0, within = 0.0, clipped = 0.0;
  for (std::size_t k = 0; k < found.rates.size(); ++k) {
    const bool late = seconds(found.rates[k].time_ns) > 5.0;
    if (late && k < found.carried.size()) least = std::min(least, found.carried[k]);
    if (!late || recording.signs[k].gyro[0] == 0) continue;
    clipped += 1.0;
    const double error = found.rates[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x();
    within += error * error < 9.0 * found.rates[k].covariance_rad2_s2(0, 0) ? 1.0 : 0.0;
  }
  std::printf("share of the hand: least %.3f; within 3 sigma %.4f\n", least, within / clipped);
  EXPECT_GT(least, 0.5);
  EXPECT_GE(within / clipped, 0.97);
}

/// Thrown while it was believed carried, and caught again: the evidence follows within the lag, both ways.
TEST(RegimeStream, ThrownAndCaughtAreSeen) {
  const SlowlyBegun motion;
  std::vector<ImuSample> samples = motion.record(100.0, 16.0, 7.3).samples;
  for (std::size_t k = 1000; k < 1080; ++k)  // the lever arm's share alone
    samples[k].specific_force_m_s2 = motion.turning(0.01 * (static_cast<double>(k) + 0.5), motion.motion.lever_arm_m);
  RegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = CarriedMotion().lever_arm_m;
  const RegimeStream stream(params);
  RegimeStream::State state = stream.start();
  std::optional<RateState> rate;
  std::vector<double> carried;
  for (const ImuSample& sample : samples) {
    ASSERT_TRUE(stream.push(sample, state, rate).ok());
    if (rate) carried.push_back(state.shares.carried);
  }
  std::printf("carried: before %.3f, thrown %.3f, after %.3f\n", carried[995], carried[1060], carried[1400]);
  EXPECT_GT(carried[995], 0.9);
  EXPECT_LT(carried[1060], 0.1);
  EXPECT_GT(carried[1400], 0.9);
}

/// Share of the hand after 0.3 s of a flight that clips, when `dropped` rigs count as dropped at its start.
double share_in_flight(std::uint64_t seed, double dropped) {
  TumbleOptions options;
  options.seed = options.mounting_seed = seed;
  options.gyro_rail_rad_s = 7.0;
  const TumbleRecording tumble = make_tumble(options);
  const auto begin = std::find(tumble.phase.begin(), tumble.phase.end(), Phase::flight) - tumble.phase.begin();
  RegimeStream::Params params;
  params.rate.model.nominal.lever_arm_m = options.lever_arm_m;
  const RegimeStream stream(params);
  RegimeStream::State state = stream.start();
  std::optional<RateState> rate;
  for (const ImuSample& sample : tumble.samples) {
    EXPECT_TRUE(stream.push(sample, state, rate).ok());
    if (state.given == static_cast<std::size_t>(begin) && rate) state.resets += dropped;
    if (state.given == static_cast<std::size_t>(begin) + 30) break;
  }
  return state.shares.carried;
}

/// A hand that throws bends the rig, which is dropped in step after step: 20 times in a lag at most. That says nothing
/// of the flight that follows: the doubt is gone before the lag is over. The control is a doubt that lasts.
TEST(RegimeStream, AFlightIsSeenThoughThePushBeforeItBentTheRig) {
  for (const std::uint64_t seed : {5, 7}) {
    EXPECT_LT(share_in_flight(seed, 20.0), 0.02) << seed;
    EXPECT_GT(share_in_flight(seed, 1e6), 0.3) << seed;
  }
}

}  // namespace
}  // namespace tumble
