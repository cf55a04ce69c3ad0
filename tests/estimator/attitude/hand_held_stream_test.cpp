// SPDX-License-Identifier: BSD-3-Clause
// Tests the hand-held streams against motions in closed form and against the batch.
#include "tumble/attitude/detail/hand_held_stream.hpp"

#include "estimator/attitude/hand_held_errors.hpp"
#include "estimator/attitude/hand_held_motion.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::clipped_errors;
using testing::HandHeldMotion;
using testing::HandHeldRecording;
using testing::quantile;

std::vector<AngularRateState> stream(const HandHeldRecording& recording, const HandHeldRateStream::Params& params,
                                     std::size_t split = 0) {
  const HandHeldRateStream stream(params);
  HandHeldRateStream::State state = stream.start();
  std::vector<AngularRateState> out;
  std::optional<AngularRateState> rate;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    SensingAxisClipSigns known;
    known.clip_signs = std::span(recording.signs).subspan(k, 1);
    if (k == split && k > 0) {
      const HandHeldRateStream::State carried_over = state;
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

/// With 1.5 s of lag, the stream is nearly as accurate as the batch, once it has found attitude and constants.
TEST(HandHeldRateStream, IsTheBatchOnALongLag) {
  const HandHeldRecording recording = testing::record({}, 100.0, 9.0, 7.3);
  HandHeldRateStream::Params params;
  params.lag_s = 1.5;
  params.window_s = 1.8;
  params.body.expert.hand_motion.hand_noise_adaptation = 0.0;  // stream and batch differ in this adaptation by design
  const std::vector<AngularRateState> live = stream(recording, params);
  std::vector<AngularRateState> batch;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  SensingAxisClipSigns clipped;
  clipped.clip_signs = recording.signs;
  ASSERT_TRUE(HandHeldSmoother(params.body).estimate(recording.samples, clipped, batch, attitudes, report).ok());
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

/// Returns the stream's result for twenty seconds of the twirl, computed once for all tests.
const HandHeldRecording& twirl() {
  static const HandHeldRecording recording = testing::record({}, 100.0, 20.0, 7.3);
  return recording;
}
const std::vector<AngularRateState>& live_twirl() {
  static const std::vector<AngularRateState> live = stream(twirl(), {});
  return live;
}

TEST(HandHeldRateStream, RecoversATwirlAtItsLag) {
  const HandHeldRecording& recording = twirl();
  const std::vector<AngularRateState>& live = live_twirl();
  std::vector<double> raw;
  std::size_t within = 0;
  for (std::size_t k = 0; k < live.size(); ++k) {
    if (recording.signs[k].gyro[0] == 0) continue;
    raw.push_back((recording.samples[k].angular_velocity_rad_s - recording.rate_rad_s[k]).norm());
    const double error = std::abs(live[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x());
    within += error < 3.0 * std::sqrt(live[k].covariance_rad2_s2(0, 0)) ? 1u : 0u;
    EXPECT_NE(live[k].source, AngularRateSource::measured);
  }
  const std::vector<double> errors = clipped_errors(recording, live, 0.0);
  const double share = static_cast<double>(within) / static_cast<double>(errors.size());
  std::printf("raw %.3f, live %.3f / %.3f, within 3 sigma %.4f\n", quantile(raw, 0.5), quantile(errors, 0.5),
              quantile(errors, 0.9), share);
  ASSERT_GT(errors.size(), 500u);
  EXPECT_LT(quantile(errors, 0.5), 0.2 * quantile(raw, 0.5));
  EXPECT_GE(share, 0.97);
}

/// The lag is counted in samples of the stated period; if samples are sparser, nodes leave the window too early, but no
/// rate may be lost.
TEST(HandHeldRateStream, GivesEachRateWhereSamplesComeSparserThanIsSaid) {
  for (const double hz : {30.0, 20.0, 12.0}) {
    const HandHeldRecording recording = testing::record({.spin_hz = 0.45}, hz, 12.0, 5.0);
    const HandHeldRateStream::Params params;
    ASSERT_GT(params.lag_s / params.period_s, hz * params.window_s);       // the lag is longer than the window
    const std::vector<AngularRateState> live = stream(recording, params);  // one result per sample
    std::vector<double> raw;
    for (std::size_t k = 0; k < live.size(); ++k) {
      EXPECT_GT(live[k].covariance_rad2_s2.diagonal().minCoeff(), 0.0) << hz << " Hz, " << k;
      if (recording.signs[k].gyro[0] == 0) continue;
      raw.push_back((recording.samples[k].angular_velocity_rad_s - recording.rate_rad_s[k]).norm());
    }
    const std::vector<double> errors = clipped_errors(recording, live, 0.0);
    std::printf("%.0f Hz: raw %.3f, live %.3f\n", hz, quantile(raw, 0.5), quantile(errors, 0.5));
    EXPECT_LT(quantile(errors, 0.5), 0.5 * quantile(raw, 0.5)) << hz;
    const std::vector<AngularRateState> parts = stream(recording, params, 101);
    for (std::size_t k = 0; k < live.size(); ++k) ASSERT_EQ(live[k].w_WI_I_rad_s, parts[k].w_WI_I_rad_s) << k;
  }
}

/// Wrapped readings contain no information; treated as unsaturated, they would have the wrong sign.
TEST(HandHeldRateStream, ReadingsThatWrapSayNothing) {
  const HandHeldRecording clipped = testing::record({}, 100.0, 12.0, 7.3);
  const HandHeldRecording wrapped = testing::with_wraps(clipped, ClipSigns::kMissingSign);
  const HandHeldRecording believed = testing::with_wraps(clipped, 0);
  const auto median = [](const HandHeldRecording& recording, const std::vector<AngularRateState>& rates) {
    std::vector<double> errors;
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if (std::abs(recording.rate_rad_s[k].x()) <= 7.3) continue;
      errors.push_back((rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
    }
    return quantile(errors, 0.5);
  };
  const std::vector<AngularRateState> live = stream(wrapped, {});
  for (std::size_t k = 0; k < live.size(); ++k) {
    if (wrapped.signs[k].gyro[0] == 0) continue;
    EXPECT_NE(live[k].source, AngularRateSource::measured) << k;
    EXPECT_EQ(live[k].clipped_axes, 1) << k;
  }
  // only the first twelve seconds
  const std::vector<AngularRateState> all_live(live_twirl().begin(), live_twirl().begin() + 1200);
  const double all = median(clipped, all_live), without = median(wrapped, live);
  const double free = median(believed, stream(believed, {}));
  std::printf("clipped %.3f, a third of them wrapped %.3f, believed %.3f\n", all, without, free);
  EXPECT_LT(without, 1.3 * all);
  EXPECT_GT(free, 5.0 * all);
}

TEST(HandHeldRateStream, SplitsAnywhereToTheBit) {
  for (const double hz : {100.0, 500.0}) {
    const HandHeldRecording recording = testing::record({}, hz, 2.0, 7.3);
    HandHeldRateStream::Params params;
    params.period_s = 1.0 / hz;
    const std::vector<AngularRateState> whole = stream(recording, params);
    for (const std::size_t split : {1u, 77u, 161u}) {
      const std::vector<AngularRateState> parts = stream(recording, params, split);
      for (std::size_t k = 0; k < whole.size(); ++k) {
        ASSERT_EQ(whole[k].w_WI_I_rad_s, parts[k].w_WI_I_rad_s) << hz << " Hz, " << k;
        ASSERT_EQ(whole[k].covariance_rad2_s2, parts[k].covariance_rad2_s2) << hz << " Hz, " << k;
      }
    }
  }
}

TEST(HandHeldRateStream, StatesACovarianceWithEachRate) {
  for (const double hz : {100.0, 200.0, 500.0}) {
    HandHeldRateStream::Params params;
    params.period_s = 1.0 / hz;
    const std::vector<AngularRateState> rates = stream(testing::record({}, hz, 2.0, 7.3), params);
    ASSERT_FALSE(rates.empty());
    for (std::size_t k = 0; k < rates.size(); ++k)
      ASSERT_GT(rates[k].covariance_rad2_s2.diagonal().minCoeff(), 0.0) << hz << " Hz, " << k;
  }
}

TEST(HandHeldRateStream, RefusesBadInputAndKeepsItsState) {
  const HandHeldRecording recording = testing::record({}, 100.0, 1.0, 7.3);
  const HandHeldRateStream stream({});
  HandHeldRateStream::State state = stream.start();
  std::optional<AngularRateState> rate;
  SensingAxisClipSigns known;
  for (std::size_t k = 0; k < 50; ++k) {
    known.clip_signs = std::span(recording.signs).subspan(k, 1);
    ASSERT_TRUE(stream.push(recording.samples[k], known, state, rate).ok());
  }
  const auto error_code = [&](ImuSample sample, const SensingAxisClipSigns& with) {
    const std::size_t before = state.samples;
    const Status status = stream.push(sample, with, state, rate);
    EXPECT_EQ(state.samples, before + (status.ok() ? 1u : 0u));
    EXPECT_TRUE(status.ok() || !rate);
    return status.error_code;
  };
  ImuSample bad = recording.samples[50];
  bad.specific_force_m_s2.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_code(bad, known), ErrorCode::non_finite);
  EXPECT_EQ(error_code(recording.samples[49], known), ErrorCode::time_order);
  bad = recording.samples[50];
  bad.time_ns += 3'000'000'000;
  EXPECT_EQ(error_code(bad, known), ErrorCode::gap);
  EXPECT_EQ(error_code(recording.samples[50], {}), ErrorCode::out_of_range);
  SensingAxisClipSigns flat = known;
  flat.sensing_directions.setZero();
  EXPECT_EQ(error_code(recording.samples[50], flat), ErrorCode::degenerate);
  EXPECT_EQ(error_code(recording.samples[50], known), ErrorCode::none);
  // a drop-out longer than the window, and further samples
  bad = recording.samples[60];
  bad.time_ns += 800'000'000;
  EXPECT_EQ(error_code(bad, known), ErrorCode::none);
  HandHeldRateStream::Params params;
  params.window_s = params.lag_s;
  EXPECT_THROW(HandHeldRateStream{params}, InvalidParams);
  params = {};
  params.period_s = 0.0;
  EXPECT_THROW(HandHeldRateStream{params}, InvalidParams);
  params = {};
  params.body.expert.node_s = 0.0;
  EXPECT_THROW(HandHeldRateStream{params}, InvalidParams);
}

}  // namespace
}  // namespace tumble
