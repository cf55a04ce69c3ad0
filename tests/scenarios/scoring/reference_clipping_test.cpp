// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/reference_clipping.hpp"

#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/score.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRail = 7.3, kTilt = 0.05, kOffset = -0.05;

/// A Made contains a gyro whose saturation level on x is tilted and offset, and a reference with noise and a gap.
struct Made {
  std::vector<Vector3d> rate, reading, reference;
  std::vector<bool> clipped;
};

Made made(double peak_rad_s, double reference_noise_rad_s) {
  Made out;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> noise;
  for (int k = 0; k < 6000; ++k) {
    const double t = 0.01 * k;
    const Vector3d w(peak_rad_s * std::sin(2.1 * t) * std::sin(0.3 * t), 2.0 * std::sin(1.7 * t),
                     3.0 * std::sin(1.1 * t));
    const double up = kRail + kOffset + kTilt * w.z(), down = -kRail + kOffset + kTilt * w.z();
    Vector3d y(std::clamp(w.x(), down, up), w.y(), w.z());
    out.clipped.push_back(y.x() != w.x());
    out.rate.push_back(w);
    for (int j = 0; j < 3; ++j) y[j] += 0.005 * noise(engine);
    out.reading.push_back(y);
    Vector3d seen = w;
    for (int j = 0; j < 3; ++j) seen[j] += reference_noise_rad_s * noise(engine);
    if (k >= 3000 && k < 3050) seen.setConstant(kNaN);
    out.reference.push_back(seen);
  }
  return out;
}

TEST(ReferenceClipping, FindsTheTiltedPlaneOfEachSign) {
  const Made recording = made(12.0, 0.1);
  const auto rails = reference_rails(recording.reading, recording.reference);
  ASSERT_TRUE(rails[0].found);
  ASSERT_TRUE(rails[1].found);
  EXPECT_NEAR(rails[0].rail_rad_s, kRail + kOffset, 0.01);
  EXPECT_NEAR(rails[0].slopes[1], kTilt, 0.005) << "s y = r + c . y";
  EXPECT_NEAR(rails[1].rail_rad_s, kRail - kOffset, 0.01);
  EXPECT_NEAR(rails[1].slopes[1], -kTilt, 0.005);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_FALSE(rails[i].found) << "axes y and z turn around freely";
}

TEST(ReferenceClipping, CallsTheClippedSamplesAndNoOthers) {
  const Made recording = made(12.0, 0.1);
  const auto axes = clipped_by_reference(recording.reading, recording.reference);
  std::size_t clipped = 0, deep_missed = 0, free_called = 0;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (!recording.reference[k].allFinite()) {
      EXPECT_EQ(axes[k], 0) << "unknown";
      continue;
    }
    const double deficit = std::abs(recording.rate[k].x() - recording.reading[k].x());
    clipped += recording.clipped[k] ? 1 : 0;
    if (deficit > 0.5 && axes[k] != 1) ++deep_missed;
    // within 2 % of the saturation level and the reference's noise, a sample may be classified either way
    if (std::abs(recording.rate[k].x()) < 0.93 * kRail && axes[k] != 0) ++free_called;
  }
  ASSERT_GT(clipped, 500u);
  EXPECT_EQ(deep_missed, 0u);
  EXPECT_EQ(free_called, 0u);
}

// the negative controls are a motion that stays below the saturation level, and one that only reverses at its peak
TEST(ReferenceClipping, AMotionWithoutASaturationLimitHasNone) {
  for (const double peak : {3.0, 7.0}) {
    const Made recording = made(peak, 0.1);
    for (const ReferenceRail& rail : reference_rails(recording.reading, recording.reference)) EXPECT_FALSE(rail.found);
  }
  EXPECT_TRUE(clipped_by_reference({}, {}).empty());
}

sim::Recording recorded(const Made& made) {
  sim::Recording recording;
  sim::ImuRecord imu;
  imu.name = "imu", imu.period_ns = 10'000'000;
  sim::ImuTruth truth;
  truth.name = "imu";
  for (std::size_t k = 0; k < made.reading.size(); ++k) {
    imu.time_ns.push_back(static_cast<std::int64_t>(k) * imu.period_ns);
    imu.gyro_rad_s.push_back(made.reading[k]);
    imu.accel_m_s2.emplace_back(0.0, 0.0, 9.8);
    imu.clip_flags.push_back(0);
  }
  truth.rate_rad_s = made.reference;
  recording.sensors.imus.push_back(imu);
  recording.truth.imus.push_back(truth);
  return recording;
}

Estimate estimate_of(const std::vector<Vector3d>& rates, double sigma_rad_s, std::uint8_t clipped_axes) {
  Estimate estimate;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    AngularRateState state;
    state.time_ns = static_cast<std::int64_t>(k) * 10'000'000;
    state.w_WI_I_rad_s = rates[k];
    state.covariance_rad2_s2 = sigma_rad_s * sigma_rad_s * Eigen::Matrix3d::Identity();
    state.clipped_axes = clipped_axes;
    estimate.rates.push_back(state);
  }
  return estimate;
}

std::map<std::string, double> scores_of(const Estimate& estimate, const sim::Recording& recording) {
  const ScoringInput input{&recording.sensors, &recording.truth, nullptr};
  std::map<std::string, double> values;
  for (const Score& score : score(Kind::rate, {estimate, input})) values[score.metric] = score.value;
  EXPECT_EQ(verdict(Kind::rate, {estimate, input}), OutcomeStatus::ok);
  return values;
}

TEST(ReferenceRateScores, OfTheTruthAndOfTheReadings) {
  const Made made_ = made(12.0, 0.1);
  const sim::Recording recording = recorded(made_);
  const auto truth = scores_of(estimate_of(made_.rate, 0.01, 1), recording);
  // the norm of three normal errors of 0.1 rad/s has the median 0.154 and the 90 % quantile 0.250
  EXPECT_NEAR(truth.at("rate_error_clipped_median_rad_s"), 0.154, 0.015);
  EXPECT_NEAR(truth.at("rate_error_clipped_p90_rad_s"), 0.250, 0.02);
  EXPECT_NEAR(truth.at("rate_error_x_clipped_median_rad_s"), 0.0675, 0.01) << "of one axis";
  EXPECT_NEAR(truth.at("rate_reference_error_median_rad_s"), 0.154, 0.01)
      << "the reference's own, seen at free samples";
  EXPECT_NEAR(truth.at("rate_reference_error_p90_rad_s"), 0.250, 0.01);
  EXPECT_NEAR(truth.at("rate_reference_coverage_3sigma"), 0.997, 0.004);
  EXPECT_LT(truth.at("rate_coverage_3sigma"), 0.5) << "which does not count the reference's error";
  EXPECT_EQ(truth.at("rate_clipped_called_measured"), 0.0);
  EXPECT_GT(truth.at("rate_reference_clipped_samples"), 500.0);
  EXPECT_FALSE(truth.contains("rate_error_y_clipped_median_rad_s")) << "y never clips";
  const auto raw = scores_of(estimate_of(made_.reading, 0.01, 0), recording);
  EXPECT_GT(raw.at("rate_error_clipped_median_rad_s"), 1.0);
  EXPECT_GT(raw.at("rate_speed_error_clipped_median_rad_s"), 1.0);
  EXPECT_LT(raw.at("rate_reference_coverage_3sigma"), 0.5);
  EXPECT_EQ(raw.at("rate_clipped_called_measured"), 1.0);
  Estimate doubting = estimate_of(made_.reading, 0.01, 0), of_another_axis = estimate_of(made_.reading, 0.01, 2);
  for (AngularRateState& rate : doubting.rates) rate.source = AngularRateSource::lower_bound_only;
  for (AngularRateState& rate : of_another_axis.rates) rate.source = AngularRateSource::lower_bound_only;
  EXPECT_EQ(scores_of(doubting, recording).at("rate_clipped_called_measured"), 0.0);
  EXPECT_EQ(scores_of(of_another_axis, recording).at("rate_clipped_called_measured"), 1.0);
  EXPECT_EQ(raw.at("rate_reference_error_median_rad_s"), truth.at("rate_reference_error_median_rad_s"))
      << "no estimate enters";
}

// a turned frame changes the components and keeps the size
TEST(ReferenceRateScores, SpeedIsBlindToAFrameThatIsTurned) {
  Made made_ = made(12.0, 0.0);
  const Matrix3d turn = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const sim::Recording recording = recorded(made_);
  std::vector<Vector3d> turned;
  for (const Vector3d& w : made_.rate) turned.push_back(turn * w);
  const auto values = scores_of(estimate_of(turned, 0.01, 1), recording);
  EXPECT_LT(values.at("rate_speed_error_clipped_median_rad_s"), 1e-9);
  EXPECT_GT(values.at("rate_error_clipped_median_rad_s"), 0.5);
}

}  // namespace
}  // namespace tumble::scenarios
