// SPDX-License-Identifier: BSD-3-Clause
// Tests how a stream treats uncertain device errors: the mixture against closed forms, and an AngularRateStream of a
// device whose errors are not corrected.
#include "tumble/angular_velocity/detail/sensor_errors.hpp"

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {
namespace {

constexpr int kDelay = SensorErrors::kDelay;

SensorErrorInformation delay_of(double delay_s, double sigma_s) {
  SensorErrorInformation out;
  out.information(kDelay, kDelay) = 1.0 / (sigma_s * sigma_s);
  out.gradient[kDelay] = delay_s / (sigma_s * sigma_s);
  return out;
}

SensorErrorUncertainty::Posterior posterior_by(const SensorErrorUncertainty& device,
                                               const SensorErrorInformation& evidence) {
  SensorErrorUncertainty::WorkMatrices work;
  SensorErrorUncertainty::Posterior out;
  device.update(evidence, work, out);
  return out;
}

TEST(SensorErrorUncertainty, WithoutEvidenceIsTheMixtureAssumed) {
  const SensorErrorPriors sizes;
  const SensorErrorUncertainty::Posterior posterior = posterior_by(SensorErrorUncertainty(sizes, 0.3), {});
  EXPECT_NEAR(posterior.uncalibrated_probability, 0.3, 1e-12);
  const SensorErrors::Vector sheet = prior_sigmas(sizes, 0.0), unknown = prior_sigmas(sizes, 1.0);
  const SensorErrors::Vector expected = 0.7 * sheet.cwiseAbs2() + 0.3 * unknown.cwiseAbs2();
  EXPECT_LT((posterior.covariance.diagonal() - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ((posterior.covariance - SensorErrors::Matrix(posterior.covariance.diagonal().asDiagonal())).norm(), 0.0);
}

// With one unknown, odds, mean and variance follow by hand. The information of samples has weight 0.3 for the odds, and
// 0.03 for the errors.
TEST(SensorErrorUncertainty, IsBayesOverTwoDevices) {
  const SensorErrorPriors sizes;
  const double delay_s = 1.5e-4, sigma_s = 1e-4;
  const SensorErrorUncertainty::Posterior posterior =
      posterior_by(SensorErrorUncertainty(sizes, 0.3), delay_of(delay_s, sigma_s));
  const double of_odds_s = sigma_s / std::sqrt(0.3), believed_s = sigma_s / std::sqrt(0.03);
  const auto density = [&](double size) {
    const double variance = size * size + of_odds_s * of_odds_s;
    return std::exp(-0.5 * delay_s * delay_s / variance) / std::sqrt(variance);
  };
  const double of_sheet = 0.7 * density(sizes.delay_s), of_unknown = 0.3 * density(sizes.delay_uncalibrated_s);
  const double unlike = of_unknown / (of_sheet + of_unknown);
  EXPECT_NEAR(posterior.uncalibrated_probability, unlike, 1e-9);
  const auto about_nil = [&](double size) {
    const double told = 1.0 / (believed_s * believed_s), mean = delay_s * told / (told + 1.0 / (size * size));
    return 1.0 / (told + 1.0 / (size * size)) + mean * mean;
  };
  const double expected = (1.0 - unlike) * about_nil(sizes.delay_s) + unlike * about_nil(sizes.delay_uncalibrated_s);
  EXPECT_NEAR(posterior.covariance(kDelay, kDelay), expected, 1e-9 * expected);
}

TEST(SensorErrorUncertainty, APlainDelayLeavesAllOpenAndNoneTakesTheSheetsWord) {
  const SensorErrorUncertainty device({}, 0.3);
  const SensorErrorUncertainty::Posterior late = posterior_by(device, delay_of(8e-3, 1e-4)),
                                          in_time = posterior_by(device, delay_of(0.0, 1e-5));
  EXPECT_GT(late.uncalibrated_probability, 0.999);
  EXPECT_GT(late.covariance(kDelay, kDelay), 8e-3 * 8e-3 * 0.9);
  EXPECT_GT(late.covariance(0, 0), 0.9 * 0.01 * 0.01) << "who states one wrongly states all wrongly";
  EXPECT_LT(in_time.uncalibrated_probability, 0.02);
  EXPECT_GT(device.common_delay_variance_s2(late), 10.0 * device.common_delay_variance_s2(in_time));
}

TEST(SensorErrorUncertainty, WithoutCalibrationTheDataSheetIsUsed) {
  const SensorErrorPriors sizes;
  const SensorErrorUncertainty::Posterior posterior =
      posterior_by(SensorErrorUncertainty(sizes, 0.0), delay_of(8e-3, 1e-4));
  EXPECT_EQ(posterior.uncalibrated_probability, 0.0);
  EXPECT_LE(posterior.covariance(0, 0), 1.001 * prior_sigmas(sizes, 0.0)[0] * prior_sigmas(sizes, 0.0)[0]);
}

TEST(SensorErrorUncertainty, EvidenceThatIsNoNumberLeavesWhatWasOpen) {
  const SensorErrorUncertainty device({}, 0.3);
  SensorErrorInformation bad = delay_of(8e-3, 5e-4);
  bad.gradient[0] = std::numeric_limits<double>::quiet_NaN();
  SensorErrorUncertainty::Posterior before;
  device.reset(before);
  EXPECT_EQ(posterior_by(device, bad).covariance, before.covariance);
  EXPECT_EQ(posterior_by(device, bad).uncalibrated_probability, before.uncalibrated_probability);
}

struct Held {
  std::size_t inside = 0, all = 0;
  double share() const { return static_cast<double>(inside) / static_cast<double>(all); }
};

void add(const TumbleRecording& recording, const AngularRateStream::Params& params, Held& held) {
  const AngularRateStream method(params);
  AngularRateStream::State state = method.start();
  std::vector<AngularRateState> out;
  std::optional<AngularRateState> one;
  for (const ImuSample& sample : recording.samples) {
    ASSERT_TRUE(method.push(sample, state, one).ok());
    if (one) out.push_back(*one);
  }
  method.flush(state, out);
  ASSERT_EQ(out.size(), recording.samples.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (recording.phase[k] == Phase::rest) continue;
    for (int j = 0; j < 3; ++j) {
      const double error = out[k].w_WI_I_rad_s[j] - recording.truth[k][j];
      held.inside += error * error <= 9.0 * out[k].covariance_rad2_s2(j, j);
      ++held.all;
    }
  }
}

// The device has scales that are 1 % wrong and an accelerometer that is one sample late, without correction. Negative
// control: if the data sheet is accepted, the stated uncertainty is too small.
TEST(RateStreamDevices, OneThatNobodyCalibratedIsNotSilent) {
  Held consumer, believed, as_stated;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    TumbleOptions options;
    options.seed = options.mounting_seed = seed;
    const auto params = with_lever_arm<AngularRateStream::Params>();
    add(make_tumble(options), params, as_stated);
    options.gyro_error.diagonal() = Eigen::Vector3d(0.01, -0.01, 0.01);
    options.accel_error.diagonal() = Eigen::Vector3d(-0.01, 0.01, 0.01);
    TumbleRecording recording = make_tumble(options);
    for (std::size_t k = recording.samples.size(); k-- > 1;)
      recording.samples[k].specific_force_m_s2 = recording.samples[k - 1].specific_force_m_s2;
    add(recording, params, consumer);
    auto sure = params;
    sure.calibrated_errors = std::make_shared<KnownSensorErrors>();
    add(recording, sure, believed);
  }
  ASSERT_GT(consumer.all, 5000u);
  EXPECT_GT(consumer.share(), 0.985);                       // measured 0.994
  EXPECT_GT(as_stated.share(), 0.985);                      // measured 0.996
  EXPECT_LT(believed.share(), 0.75) << "negative control";  // measured 0.641
}

TEST(RateStreamDevices, WhatIsNoCovarianceIsRefused) {
  auto params = with_lever_arm<AngularRateStream::Params>();
  const auto learnt = std::make_shared<KnownSensorErrors>();
  params.calibrated_errors = learnt;
  EXPECT_NO_THROW(AngularRateStream{params});
  learnt->covariance(0, 0) = -0.01;
  EXPECT_THROW(AngularRateStream{params}, InvalidParams);
  learnt->covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(AngularRateStream{params}, InvalidParams);
}

}  // namespace
}  // namespace tumble
