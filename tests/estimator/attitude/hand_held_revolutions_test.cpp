// SPDX-License-Identifier: BSD-3-Clause
// Tests what the hand-held stream states if no data determine the rate: an accelerometer without information while the
// gyro clips, in closed form.
#include "estimator/attitude/clipped_spin.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"

namespace tumble {
namespace {

using testing::ClippedSpin;
using testing::SpinReadings;

/// Returns parameters of the stream with a calm hand and the given lag.
HandHeldRateStream::Params calm_hand(double lag_s) {
  HandHeldRateStream::Params out;
  out.lag_s = lag_s;
  out.window_s = lag_s + 0.5;
  out.body.hand_sigma_m_s2 = 1.0;
  out.body.gyro_bias_sigma_rad_s = 1e-3;
  return out;
}

/// HiddenRate is the error of the rate about the spin's axis at one clipped sample, with its stated deviation.
struct HiddenRate {
  double error_rad_s = 0.0, sigma_rad_s = 0.0, at = 0.0;  ///< `at`: elapsed share of the segment
};

struct LiveSpin {
  std::vector<HiddenRate> hidden;
  std::size_t revolutions_ambiguous = 0;

  LiveSpin(const ClippedSpin& spin, const HandHeldRateStream::Params& params) {
    const SpinReadings readings(spin);
    const HandHeldRateStream stream(params);
    HandHeldRateStream::State state = stream.start();
    std::vector<AngularRateState> rates;
    std::optional<AngularRateState> rate;
    for (std::size_t k = 0; k < readings.samples.size(); ++k) {
      const SensingAxisClipSigns known{Eigen::Matrix3d::Identity(), std::span(readings.signs).subspan(k, 1)};
      EXPECT_TRUE(stream.push(readings.samples[k], known, state, rate).ok());
      if (rate) rates.push_back(*rate);
    }
    EXPECT_EQ(state.failures, 0u);
    revolutions_ambiguous = state.revolutions_ambiguous;
    for (const AngularRateState& each : rates) {
      const double t = seconds(each.time_ns) - 0.5 / SpinReadings::kHz;
      if (!spin.within(t)) continue;
      hidden.push_back({std::abs(each.w_WI_I_rad_s.x() - spin.rate(t)), std::sqrt(each.covariance_rad2_s2(0, 0)),
                        (t - spin.from_s) / spin.lasts_s});
    }
    std::printf("%.1f s, %.1f more: of %zu samples %td beyond 3 sigma, open %zu, in the middle %.2f of %.2f rad/s\n",
                spin.lasts_s, spin.more_rad_s, hidden.size(), beyond(), revolutions_ambiguous, middle().error_rad_s,
                middle().sigma_rad_s);
  }
  std::ptrdiff_t beyond() const {
    return std::count_if(hidden.begin(), hidden.end(),
                         [](const HiddenRate& h) { return h.error_rad_s > 3.0 * h.sigma_rad_s; });
  }
  HiddenRate middle() const {
    return *std::min_element(hidden.begin(), hidden.end(), [](const HiddenRate& a, const HiddenRate& b) {
      return std::abs(a.at - 0.5) < std::abs(b.at - 0.5);
    });
  }
};

/// Returns the additional rate, sin^2 in time, of a body that turns once more than a uniform rotation.
double once_more(double lasts_s) {
  return 4.0 * std::numbers::pi / lasts_s;
}

/// Returns the deviation in the middle of a segment with known rate, angular acceleration and angle at its ends:
/// carried.md (C41).
double closed_form_sigma(const HandHeldRateStream::Params& params, double lasts_s) {
  const double q = std::pow(params.body.expert.jerk_inflation * params.body.jerk_rad_s3_sqrts, 2.0);
  return std::sqrt(q * std::pow(lasts_s + 1.0 / SpinReadings::kHz, 3.0) * (1.0 / 192.0 - 720.0 / (384.0 * 384.0)));
}

/// A segment contains a whole turn more, half a turn or none, as white jerk allows; the stated deviation must include
/// them, and the report must say so. When bounds counted as readings, a third of these samples, 408, were beyond three
/// deviations.
TEST(HandHeldRevolutions, ATurnThatNothingDeterminesIsReported) {
  std::size_t all = 0, beyond = 0;
  for (const double from_s : {2.0, 2.3}) {
    for (const double lasts_s : {0.7, 1.2}) {
      for (const double turns : {0.0, 0.5, 1.0}) {
        const double more_rad_s = 1.0 + turns * once_more(lasts_s);
        const ClippedSpin spin{.more_rad_s = more_rad_s, .from_s = from_s, .lasts_s = lasts_s, .duration_s = 4.5};
        const LiveSpin live(spin, calm_hand(0.2));
        EXPECT_LT(live.middle().error_rad_s, 3.0 * live.middle().sigma_rad_s)
            << from_s << " " << lasts_s << " " << turns;
        EXPECT_EQ(live.revolutions_ambiguous, 1u) << from_s << " " << lasts_s << " " << turns;
        all += live.hidden.size();
        beyond += static_cast<std::size_t>(live.beyond());
      }
    }
  }
  EXPECT_EQ(all, 1140u);
  EXPECT_EQ(beyond, 0u);
}

/// If the whole segment is in the window, the deviation is that of the jerk between known ends, at the saturation level
/// and far beyond it.
TEST(HandHeldRevolutions, ABoundSaysNothingOfHowFar) {
  const HandHeldRateStream::Params params = calm_hand(0.6);
  for (const double lasts_s : {0.3, 0.5}) {
    for (const double more_rad_s : {1.0, 10.0}) {
      const LiveSpin live({.more_rad_s = more_rad_s, .from_s = 2.0, .lasts_s = lasts_s, .duration_s = 4.5}, params);
      const double expected = closed_form_sigma(params, lasts_s);
      std::printf("closed form: %.2f rad/s\n", expected);
      EXPECT_NEAR(live.middle().sigma_rad_s, expected, 0.1 * expected) << lasts_s << " " << more_rad_s;
    }
  }
}

/// Negative controls: a segment too short for a turn hides none, and a segment in which gravity rotates visibly is
/// known.
TEST(HandHeldRevolutions, AShortSegmentHidesNoTurn) {
  const LiveSpin brief({.more_rad_s = 3.0, .from_s = 2.0, .lasts_s = 0.15, .duration_s = 4.5}, calm_hand(0.2));
  EXPECT_EQ(brief.revolutions_ambiguous, 0u);
  EXPECT_LT(brief.middle().sigma_rad_s, 1.5);
  EXPECT_EQ(brief.beyond(), 0);
  const LiveSpin seen({.more_rad_s = 3.0, .from_s = 2.0, .lasts_s = 0.5, .duration_s = 4.5, .blind = false},
                      calm_hand(0.2));
  EXPECT_EQ(seen.revolutions_ambiguous, 0u);
  EXPECT_LT(seen.middle().sigma_rad_s, 2.0);
  EXPECT_LT(seen.middle().error_rad_s, 0.2);
}

}  // namespace
}  // namespace tumble
