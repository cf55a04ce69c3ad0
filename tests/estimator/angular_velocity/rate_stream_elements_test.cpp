// SPDX-License-Identifier: BSD-3-Clause
// Tests the stream on gyros whose elements clip along their own axes, without flags and without a stated range.
#include "estimator/angular_velocity/drawn_elements.hpp"
#include "estimator/angular_velocity/quantile.hpp"
#include "estimator/angular_velocity/streamed_rates.hpp"
#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {
namespace {

using testing::quantile;

Pool streamed(double tilt, const AngularRateStream::Params& params = with_lever_arm<AngularRateStream::Params>()) {
  Pool pool;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const TumbleRecording tumble = tilted_tumble(seed, tilt);
    const AngularRateStream method(params);
    AngularRateStream::State state = method.start();
    pool.add(tumble, streamed_rates(method, tumble.samples, state));
    EXPECT_EQ(state.failures, 0u);
  }
  return pool;
}

TEST(RateStreamElements, ATiltedRailIsReadAsAnUprightOne) {
  const Pool upright = streamed(0.0), tilted = streamed(0.02), steep = streamed(0.05);
  ASSERT_GT(tilted.ours.size(), 800u);
  for (const Pool* pool : {&tilted, &steep}) {
    EXPECT_LT(quantile(pool->ours, 0.5), 0.05 * quantile(pool->raw, 0.5));
    // measured up to 2.9 times: the tumble must determine six more constants, which it also needs
    EXPECT_LT(quantile(pool->ours, 0.5), 3.3 * quantile(upright.ours, 0.5));
    EXPECT_GE(pool->found, 0.98 * pool->deep);
    EXPECT_GE(pool->right, 0.99 * pool->called);
    EXPECT_GT(pool->share_within(), 0.95);
  }
}

// Negative control: a stream that does not search planes accepts the wrong readings.
TEST(RateStreamElements, WithoutPlanesItWouldBeSilentlyWrong) {
  auto params = with_lever_arm<AngularRateStream::Params>();
  params.expert.gyro_planes.distance_min_rad_s = 1000.0;
  const Pool pool = streamed(0.02, params);
  EXPECT_GT(quantile(pool.ours, 0.5), 0.3 * quantile(pool.raw, 0.5));
  EXPECT_LT(pool.share_within(), 0.8);
}

TEST(RateStreamElements, WithALongLagItIsTheBatch) {
  for (const double tilt : {0.0, 0.03}) {
    for (std::uint64_t seed = 3; seed <= 4; ++seed) {
      const TumbleRecording tumble = tilted_tumble(seed, tilt);
      auto params = with_lever_arm<AngularRateStream::Params>();
      params.lag_s = 9.0;  // so that all samples remain in the window
      params.expert.inflation.covariance = 0.0;
      const AngularRateStream method(params);
      AngularRateStream::State state = method.start();
      const std::vector<AngularRateState> live = streamed_rates(method, tumble.samples, state);
      auto batch_params = with_lever_arm<AngularRateSmoother::Params>();
      batch_params.model = params.model;
      std::vector<AngularRateState> batch;
      AngularRateReport report;
      ASSERT_TRUE(AngularRateSmoother(batch_params).estimate(tumble.samples, batch, report).ok());
      ASSERT_EQ(live.size(), batch.size());
      EXPECT_EQ(state.clipping_state.known_limits.gyro_clips_after_compensation, report.clips_after_compensation);
      std::vector<double> apart;
      int judged_apart = 0;
      for (std::size_t k = 0; k < batch.size(); ++k) {
        judged_apart += live[k].clipped_axes != batch[k].clipped_axes;
        if (batch[k].clipped_axes == 0) continue;
        const Vector3d sigma = batch[k].covariance_rad2_s2.diagonal().cwiseSqrt();
        apart.push_back((live[k].w_WI_I_rad_s - batch[k].w_WI_I_rad_s).cwiseQuotient(sigma).norm());
      }
      ASSERT_GT(apart.size(), 50u);
      // edges of segments: a sample before a segment is judged again when a level becomes known
      EXPECT_LE(judged_apart, 5) << tilt << " " << seed;
      EXPECT_LT(quantile(apart, 0.5), 0.3) << tilt << " " << seed;
      EXPECT_LT(quantile(apart, 0.9), 1.5) << tilt << " " << seed;
    }
  }
}

TEST(RateStreamElements, SplittingAnywhereChangesNothing) {
  const std::vector<ImuSample> samples = tilted_tumble(5, 0.03).samples;
  const auto params = with_lever_arm<AngularRateStream::Params>();
  const AngularRateStream method(params);
  AngularRateStream::State whole = method.start();
  (void)streamed_rates(method, samples, whole);
  ASSERT_TRUE(whole.clipping_state.known_limits.gyro_planes.any_plane_found());
  expect_same_rates_if_split(params, samples, {90, samples.size() / 3, samples.size() / 2});
}

TEST(RateStreamElements, NothingIsCalledClippedWhereNothingClips) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    TumbleOptions options;
    options.seed = seed;
    options.gyro_rail_rad_s = 1e3;
    const TumbleRecording tumble = make_tumble(options);
    const AngularRateStream method(with_lever_arm<AngularRateStream::Params>());
    AngularRateStream::State state = method.start();
    for (const AngularRateState& rate : streamed_rates(method, tumble.samples, state))
      EXPECT_EQ(rate.clipped_axes, 0) << seed;
  }
}

/// Swing is a body that swings about x, faster from 4 s on, with the x element at a tilted level of 7.4 rad/s.
struct Swing {
  std::vector<ImuSample> samples;
  std::vector<Vector3d> truth;
  explicit Swing(std::uint64_t seed, int count = 480) {
    oracles::Gaussian noise(seed);
    const Vector3d row(1.0, 0.02, -0.02);
    for (int k = 0; k < count; ++k) {
      const double t = 0.01 * k, phase = 5.0 * t;
      const Vector3d w((k < 400 ? 5.0 : 8.2) * std::sin(phase), std::sin(3.1 * t), std::cos(4.3 * t));
      const double beyond = std::abs(row.dot(w)) - 7.4;
      ImuSample sample;
      sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
      sample.angular_velocity_rad_s = w + 0.002 * noise.vector();
      if (beyond > 0.0) sample.angular_velocity_rad_s.x() -= std::copysign(beyond, w.x());
      sample.specific_force_m_s2 = Vector3d(0.0, 6.0, 7.7) + noise.vector();
      samples.push_back(sample);
      truth.push_back(w);
    }
  }
};

/// Believed counts what was reported at the level before it was known.
struct Believed {
  int clipped = 0, within = 0, measured = 0;
};

Believed believed(const AngularRateStream::Params& params) {
  Believed out;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Swing swing(seed);
    const AngularRateStream method(params);
    AngularRateStream::State state = method.start();
    std::optional<AngularRateState> rate;
    std::size_t k = 0;
    for (const ImuSample& sample : swing.samples) {
      EXPECT_TRUE(method.push(sample, state, rate).ok());
      if (!rate) continue;
      const double truth = swing.truth[k].x(), reading = swing.samples[k].angular_velocity_rad_s.x();
      ++k;
      if (std::abs(reading - truth) < 0.05 || state.clipping_state.known_limits.gyro_planes.any_plane_found()) continue;
      ++out.clipped;
      out.within += std::abs(rate->w_WI_I_rad_s.x() - truth) < 3.0 * std::sqrt(rate->covariance_rad2_s2(0, 0));
      out.measured += rate->source == AngularRateSource::measured;
    }
  }
  return out;
}

// A level is detected some samples after it was first reached, when the lag is over; until then, readings are suspect.
TEST(RateStreamElements, NothingAtASaturationLimitGoesOutAsMeasuredBeforeTheRailIsKnown) {
  auto params = with_lever_arm<AngularRateStream::Params>();
  params.lag_s = 0.06;
  params.calibrated_errors =
      std::make_shared<KnownSensorErrors>();  // a device that agrees with its data sheet: only the limit is uncertain
  const Believed suspect = believed(params);
  // negative control: axes with slower rates are accepted
  params.expert.gyro_planes.distance_min_rad_s = 1000.0;
  const Believed trusted = believed(params);
  std::printf("of %d within %d, measured %d; believed: within %d, measured %d\n", suspect.clipped, suspect.within,
              suspect.measured, trusted.within, trusted.measured);
  ASSERT_GT(suspect.clipped, 12);
  EXPECT_EQ(suspect.measured, 0);
  EXPECT_GT(trusted.measured, 0.9 * trusted.clipped);
  // not all samples: a stream that knows only flight and contact is too certain about a swing
  EXPECT_GT(suspect.within, 0.4 * suspect.clipped);
  EXPECT_LT(trusted.within, 0.05 * trusted.clipped);
}

/// Returns the number of samples at the known level, and of those within three deviations.
std::pair<int, int> within_at_known_rail(const AngularRateStream::Params& params) {
  int clipped = 0, within = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Swing swing(seed);
    const AngularRateStream method(params);
    AngularRateStream::State state = method.start();
    const std::vector<AngularRateState> rates = streamed_rates(method, swing.samples, state);
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if ((rates[k].clipped_axes & 1u) == 0) continue;
      ++clipped;
      const double sigma = std::sqrt(rates[k].covariance_rad2_s2(0, 0));
      within += std::abs(rates[k].w_WI_I_rad_s.x() - swing.truth[k].x()) < 3.0 * sigma;
    }
  }
  return {clipped, within};
}

// A swing is neither flight nor a push, so the uncertainty follows from the slopes of the run.
TEST(RateStreamElements, ARunOfClippedReadingsIsAsOpenAsItsSlopes) {
  auto params = with_lever_arm<AngularRateStream::Params>();
  const auto [clipped, within] = within_at_known_rail(params);
  params.expert.inflation.slopes = 0.0;
  const auto [same, believed] = within_at_known_rail(params);
  std::printf("of %d within %d; without what slopes hide %d of %d\n", clipped, within, believed, same);
  ASSERT_GT(clipped, 60);
  EXPECT_EQ(same, clipped);
  EXPECT_GT(within, 0.97 * clipped);
  EXPECT_LT(believed, 0.9 * clipped);
}

// With the level of x known, y stays near this height, is suspect, and is then read far beyond it within the lag.
TEST(RateStreamElements, ASuspicionThatALargerReadingRefutesIsRemoved) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::vector<ImuSample> samples = Swing(seed, 800).samples;
    constexpr std::size_t kTop = 752;  // x crosses zero at 7.54 s
    const double steps[] = {1.0, 3.5, 5.3, 6.3, 7.2, 7.2, 7.2, 7.2, 8.2, 9.0, 9.6, 9.6, 8.6, 7.0, 5.0, 3.0};
    for (std::size_t i = 0; i < std::size(steps); ++i) {
      // equal readings would be a plateau
      samples[kTop - 4 + i].angular_velocity_rad_s.y() = steps[i] + 0.002 * std::sin(37.0 * static_cast<double>(i));
    }
    auto params = with_lever_arm<AngularRateStream::Params>();
    params.calibrated_errors =
        std::make_shared<KnownSensorErrors>();  // as above; 200 rad/s^2 would reveal that the gyro may be 1 ms late
    const AngularRateStream method(params);
    AngularRateStream::State state = method.start();
    std::optional<AngularRateState> rate;
    std::vector<AngularRateState> out;
    int suspect = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      ASSERT_TRUE(method.push(samples[k], state, rate).ok());
      if (rate) out.push_back(*rate);
      if (k != kTop + 3) continue;
      ASSERT_TRUE(state.clipping_state.known_limits.gyro_planes.sensing_axis[0]);
      for (const AngularRateStream::Knot& knot : state.window)
        suspect += (knot.observation.possibly_saturated_axes() >> 1 & 1) != 0;
    }
    EXPECT_GE(suspect, 3) << seed;
    for (std::size_t k = kTop; k < kTop + 4; ++k) {
      EXPECT_EQ(out[k].source, AngularRateSource::measured) << seed << " " << k;
      EXPECT_LT(out[k].covariance_rad2_s2(1, 1), 0.01) << seed << " " << k;
    }
  }
}

// No reading refutes this suspicion, so all readings are reported as suspect, also the rest of the run.
TEST(RateStreamElements, ASuspicionStaysUntilItIsReported) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::vector<ImuSample> samples = Swing(seed).samples;
    constexpr std::size_t kTop = 377;  // x crosses zero at 3.77 s, before its first clipping
    const double steps[] = {1.0, 3.5, 5.3, 6.3, 7.2, 7.2, 7.2, 6.1, 5.0, 3.5, 2.0};
    for (std::size_t i = 0; i < std::size(steps); ++i) {
      samples[kTop - 4 + i].angular_velocity_rad_s.y() = steps[i] + 0.002 * std::sin(37.0 * static_cast<double>(i));
    }
    samples.resize(402);
    const AngularRateStream method(with_lever_arm<AngularRateStream::Params>());
    AngularRateStream::State state = method.start();
    const std::vector<AngularRateState> out = streamed_rates(method, samples, state);
    for (std::size_t k = kTop; k < kTop + 3; ++k) {
      EXPECT_EQ(out[k].source, AngularRateSource::lower_bound_only) << seed << " " << k;
    }
    EXPECT_EQ(out[kTop - 3].source, AngularRateSource::measured) << seed;
  }
}

// These readings only look saturated: a torque-free spin, the round top of a slow turn, a slow drift.
TEST(RateStreamElements, SpinsAndTopsAreNoRails) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    oracles::Gaussian noise(seed);
    const double rate = noise.uniform(4.0, 12.0), curve = noise.uniform(1.0, 300.0);
    for (const int kind : {0, 1, 2}) {
      std::vector<ImuSample> samples;
      for (int k = 0; k < 600; ++k) {
        const double t = 0.01 * k;
        const bool flying = k >= 300 && k <= 380;
        Vector3d turning = flying ? Vector3d(0.3 * std::cos(5.0 * t), 0.3 * std::sin(5.0 * t), rate)
                                  : Vector3d(0.2 * std::sin(3.0 * t), 0.3, 0.1);
        if (kind == 1) turning = {std::sin(t), std::cos(2.0 * t), 8.0 - curve * std::pow(std::fmod(t, 1.0) - 0.5, 2)};
        if (kind == 2) turning = {0.0, 0.0, k < 200 || k > 400 ? 0.0 : 1.4};
        ImuSample sample;
        sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
        sample.angular_velocity_rad_s = turning + 0.005 * noise.vector();
        sample.specific_force_m_s2 = Vector3d(0.0, 0.0, 9.81) + 0.01 * noise.vector();
        samples.push_back(sample);
      }
      const AngularRateStream method(with_lever_arm<AngularRateStream::Params>());
      AngularRateStream::State state = method.start();
      int called = 0;
      for (const AngularRateState& out : streamed_rates(method, samples, state)) called += out.clipped_axes != 0;
      EXPECT_EQ(called, 0) << seed << " " << kind;
      EXPECT_FALSE(state.clipping_state.known_limits.gyro_planes.any_plane_found()) << seed << " " << kind;
    }
  }
}

}  // namespace
}  // namespace tumble
