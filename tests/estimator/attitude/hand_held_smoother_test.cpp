// SPDX-License-Identifier: BSD-3-Clause
// Tests the hand-held smoother against motions in closed form.
#include "tumble/attitude/detail/hand_held_smoother.hpp"

#include "estimator/attitude/hand_held_errors.hpp"
#include "estimator/attitude/hand_held_motion.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::HandHeldMotion;
using testing::HandHeldRecording;
using testing::quantile;

struct HandHeldEstimate {
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
};

HandHeldEstimate smoothed_carriage(const HandHeldRecording& recording, const HandHeldSmoother::Params& params = {}) {
  HandHeldEstimate out;
  SensingAxisClipSigns clipped;
  clipped.clip_signs = recording.signs;
  const Status status =
      HandHeldSmoother(params).estimate(recording.samples, clipped, out.rates, out.attitudes, out.report);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(out.rates.size(), recording.samples.size());
  EXPECT_EQ(out.attitudes.size(), recording.samples.size());
  return out;
}

/// RateErrors contains errors of the rate where the gyro clips and where it does not, and of the raw reading where it
/// clips [rad/s].
struct RateErrors {
  std::vector<double> clipped, free, raw;
};

RateErrors rate_errors(const HandHeldRecording& recording, const HandHeldEstimate& result) {
  RateErrors out;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const double error = (result.rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm();
    if (recording.signs[k].gyro[0] == 0) {
      out.free.push_back(error);
      continue;
    }
    EXPECT_EQ(result.rates[k].clipped_axes, 1) << k;
    EXPECT_NE(result.rates[k].source, AngularRateSource::measured) << k;
    out.clipped.push_back(error);
    out.raw.push_back((recording.samples[k].angular_velocity_rad_s - recording.rate_rad_s[k]).norm());
  }
  return out;
}

double inclination_rms_rad(const HandHeldRecording& recording, const HandHeldEstimate& result) {
  double sum = 0.0;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const Eigen::Vector3d up(0.0, 0.0, 1.0);
    const Eigen::Vector3d truth = recording.q_WI[k].conjugate() * up,
                          ours = result.attitudes[k].orientation_W.conjugate() * up;
    sum += truth.cross(ours).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(recording.samples.size()));
}

/// A wrapped reading is neither a measurement nor a bound.
TEST(HandHeldSmoother, ReadingsThatWrapSayNothing) {
  const HandHeldRecording clipped = testing::record({}, 100.0, 12.0, 7.3);
  const HandHeldRecording wrapped = testing::with_wraps(clipped, ClipSigns::kMissingSign);
  const auto median = [](const HandHeldRecording& recording) {
    const HandHeldEstimate result = smoothed_carriage(recording);
    std::vector<double> errors;
    for (std::size_t k = 0; k < result.rates.size(); ++k) {
      if (std::abs(recording.rate_rad_s[k].x()) <= 7.3) continue;
      errors.push_back((result.rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
    }
    return quantile(errors, 0.5);
  };
  const double all = median(clipped), without = median(wrapped), free = median(testing::with_wraps(clipped, 0));
  std::printf("clipped %.3f, a third of them wrapped %.3f, believed %.3f\n", all, without, free);
  EXPECT_LT(without, 1.3 * all);
  EXPECT_GT(free, 5.0 * all);
}

/// Another method has recovered rates about x that are 2 rad/s too large for a third of a second: carried.md (C15)
TEST(HandHeldSmoother, ARecoveredRateIsUsedWithItsCovariance) {
  HandHeldRecording recording = testing::record({.spin_rad = 1.0}, 100.0, 12.0, 0.0);
  std::vector<Eigen::Matrix3d> told(recording.samples.size(), Eigen::Matrix3d::Zero()), untold = told;
  for (std::size_t k = 500; k < 533; ++k) {
    recording.samples[k].angular_velocity_rad_s.x() += 2.0;
    told[k](0, 0) = 4.0;
    untold[k](0, 0) = 1e-12;
  }
  const auto error = [&](const std::vector<Eigen::Matrix3d>& covariances) {
    HandHeldEstimate out;
    SensingAxisClipSigns clipped;
    clipped.clip_signs = recording.signs;
    clipped.recovered_covariance_rad2_s2 = covariances;
    const Status status =
        HandHeldSmoother({}).estimate(recording.samples, clipped, out.rates, out.attitudes, out.report);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(out.rates[510].clipped_axes, 1);
    return inclination_rms_rad(recording, out);
  };
  EXPECT_LT(error(told), 0.04);                 // 0.032
  EXPECT_GT(error(untold), 3.0 * error(told));  // negative control
}

// carried.md (C27): for a turn of 9 rad between two rests, the scale error adds nothing at the ends, and in the middle
// what half of the turn accumulates; the attitudes are unchanged. For a hand-held body without recovered rates, the
// scale error adds nothing.
TEST(HandHeldSmoother, BesideRecoveredRatesAScaleGathersOverTheTurning) {
  std::vector<ImuSample> samples(700);
  const Eigen::Vector3d rate_rad_s(3.0, 0.0, 0.0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double turned_s = std::clamp(0.01 * static_cast<double>(k) - 2.0, 0.0, 3.0);
    samples[k].time_ns = static_cast<TimeNs>(k + 1) * 10'000'000;
    if (turned_s > 0.0 && turned_s < 3.0) samples[k].angular_velocity_rad_s = rate_rad_s;
    samples[k].specific_force_m_s2 = so3::exp(turned_s * rate_rad_s).conjugate() * Eigen::Vector3d(0.0, 0.0, 9.80665);
  }
  const auto run = [&](bool recovered) {
    SensingAxisClipSigns clipped;
    const std::vector<Eigen::Matrix3d> none(samples.size(), Eigen::Matrix3d::Zero());
    if (recovered) clipped.recovered_covariance_rad2_s2 = none;
    HandHeldEstimate out;
    const Status status = HandHeldSmoother({}).estimate(samples, clipped, out.rates, out.attitudes, out.report);
    EXPECT_TRUE(status.ok()) << status.message();
    return out.attitudes;
  };
  constexpr double kShare = HandHeldSensorParams::kRecoveredScaleSigma;
  const auto without = run(false), with = run(true);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double half_rad =
        3.0 * std::max(0.0, std::min(0.01 * static_cast<double>(k) - 2.0, 5.0 - 0.01 * static_cast<double>(k)));
    // the rests are detected to a tenth of a second
    const Eigen::Vector3d added = (with[k].covariance_rad2 - without[k].covariance_rad2).diagonal();
    EXPECT_NEAR(std::sqrt(added.maxCoeff()), kShare * half_rad, kShare * 0.4) << k;
    EXPECT_EQ(with[k].orientation_W.coeffs(), without[k].orientation_W.coeffs()) << k;
  }
}

TEST(HandHeldSmoother, RefusesRecoveredRatesThatAreNone) {
  const HandHeldRecording recording = testing::record({}, 100.0, 1.0, 0.0);
  std::vector<Eigen::Matrix3d> covariances(recording.samples.size() - 1, Eigen::Matrix3d::Zero());
  HandHeldEstimate out;
  const auto error_code = [&] {
    SensingAxisClipSigns clipped;
    clipped.recovered_covariance_rad2_s2 = covariances;
    return HandHeldSmoother({}).estimate(recording.samples, clipped, out.rates, out.attitudes, out.report).error_code;
  };
  EXPECT_EQ(error_code(), ErrorCode::out_of_range);
  covariances.emplace_back(Eigen::Matrix3d::Zero());
  EXPECT_EQ(error_code(), ErrorCode::none);
  covariances[3](1, 1) = -1.0;
  EXPECT_EQ(error_code(), ErrorCode::out_of_range);
  covariances[3](1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_code(), ErrorCode::out_of_range);
}

TEST(HandHeldSmoother, AJudgedSampleHasASignForEachElement) {
  ImuSample sample;
  sample.angular_velocity_rad_s = {7.0, -7.0, -7.0};
  sample.specific_force_m_s2 = {1.0, -150.0, 150.0};
  Clipping clipping;
  clipping.gyro = 0b011;
  clipping.unusable_gyro = 0b100;
  clipping.accel = 0b110;
  const ClipSigns signs = clip_signs(sample, clipping);
  EXPECT_EQ(signs.gyro, (std::array<std::int8_t, 3>{1, -1, ClipSigns::kMissingSign}));
  EXPECT_EQ(signs.accel, (std::array<std::int8_t, 3>{0, -1, 1}));
}

TEST(HandHeldSmoother, FollowsAFreeGyroAndFindsTheVertical) {
  const HandHeldRecording recording = testing::record({}, 100.0, 20.0, 0.0);
  const HandHeldEstimate result = smoothed_carriage(recording);
  EXPECT_LT(quantile(rate_errors(recording, result).free, 0.5), 0.01);
  EXPECT_LT(inclination_rms_rad(recording, result), 0.01);
}

TEST(HandHeldSmoother, RecoversATwirlBeyondTheRail) {
  // 11.3 rad/s at the peaks, the saturation level at 7.3, half of each turn lost
  const HandHeldRecording recording = testing::record({}, 100.0, 20.0, 7.3);
  const RateErrors errors = rate_errors(recording, smoothed_carriage(recording));
  ASSERT_GT(errors.clipped.size(), 500u);
  std::printf("raw %.3f %.3f, carried %.3f %.3f, free %.4f\n", quantile(errors.raw, 0.5), quantile(errors.raw, 0.9),
              quantile(errors.clipped, 0.5), quantile(errors.clipped, 0.9), quantile(errors.free, 0.5));
  EXPECT_LT(quantile(errors.clipped, 0.5), 0.13 * quantile(errors.raw, 0.5));
  EXPECT_LT(quantile(errors.clipped, 0.9), 0.13 * quantile(errors.raw, 0.9));
}

TEST(HandHeldSmoother, SaysTheSameAtAnyRateOfTheImu) {
  std::vector<HandHeldEstimate> results;
  for (double hz : {50.0, 200.0, 2000.0}) {
    const HandHeldRecording recording = testing::record({}, hz, 8.0, 7.3);
    results.push_back(smoothed_carriage(recording));
    const double median = quantile(rate_errors(recording, results.back()).clipped, 0.5);
    std::printf("%.0f Hz: %.3f rad/s\n", hz, median);
    EXPECT_LT(median, 0.3) << hz;
  }
}

/// For a gyro with noise and bias, and one random draw of the motion, the deviations contain the errors and are not far
/// too wide.
TEST(HandHeldSmoother, DeviationsHoldTheErrors) {
  std::size_t within = 0, within_one = 0, count = 0;
  for (std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    oracles::Gaussian noise(seed);
    HandHeldMotion motion;
    motion.spin_rad = noise.uniform(2.5, 3.5), motion.spin_hz = noise.uniform(0.5, 0.7);
    motion.hand_hz = noise.uniform(0.5, 1.5);
    HandHeldRecording recording = testing::record(motion, 100.0, 12.0, 7.3);
    for (std::size_t k = 0; k < recording.samples.size(); ++k) {
      ImuSample& sample = recording.samples[k];
      for (int j = 0; j < 3; ++j) {
        if (recording.signs[k].gyro[static_cast<std::size_t>(j)] == 0)
          sample.angular_velocity_rad_s[j] += 0.005 * noise();
        sample.specific_force_m_s2[j] += 0.05 * noise();
      }
    }
    const HandHeldEstimate result = smoothed_carriage(recording);
    for (std::size_t k = 0; k < recording.samples.size(); ++k) {
      if (recording.signs[k].gyro[0] == 0) continue;
      const double sigma = std::sqrt(result.rates[k].covariance_rad2_s2(0, 0));
      const double error = std::abs(result.rates[k].w_WI_I_rad_s.x() - recording.rate_rad_s[k].x());
      ++count;
      within += error < 3.0 * sigma ? 1u : 0u;
      within_one += error < 0.05 * sigma ? 1u : 0u;
    }
  }
  ASSERT_GT(count, 500u);
  const double share = static_cast<double>(within) / static_cast<double>(count);
  const double tiny = static_cast<double>(within_one) / static_cast<double>(count);
  std::printf("within 3 sigma %.4f, within a twentieth %.4f\n", share, tiny);
  EXPECT_GE(share, 0.97);
  EXPECT_LT(tiny, 0.5) << "a deviation twenty times the error says nothing";
}

TEST(HandHeldSmoother, RefusesBadInput) {
  const HandHeldRecording good = testing::record({}, 100.0, 1.0, 0.0);
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  const auto error_code = [&](const HandHeldRecording& recording, SensingAxisClipSigns clipped = {}) {
    const Status status = HandHeldSmoother({}).estimate(recording.samples, clipped, rates, attitudes, report);
    EXPECT_TRUE(status.ok() || (rates.empty() && attitudes.empty()));
    return status.error_code;
  };
  EXPECT_EQ(error_code(good), ErrorCode::none);
  EXPECT_EQ(error_code({}), ErrorCode::empty);
  HandHeldRecording bad = good;
  bad.samples[50].angular_velocity_rad_s.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_code(bad), ErrorCode::non_finite);
  bad = good;
  std::swap(bad.samples[50].time_ns, bad.samples[51].time_ns);
  EXPECT_EQ(error_code(bad), ErrorCode::time_order);
  bad = good;
  for (std::size_t k = 50; k < bad.samples.size(); ++k) bad.samples[k].time_ns += 3'000'000'000;
  EXPECT_EQ(error_code(bad), ErrorCode::gap);
  SensingAxisClipSigns clipped;
  clipped.clip_signs = std::span(good.signs).first(5);
  EXPECT_EQ(error_code(good, clipped), ErrorCode::out_of_range);
  clipped = {};
  clipped.sensing_directions.setZero();
  EXPECT_EQ(error_code(good, clipped), ErrorCode::degenerate);
  EXPECT_THROW(HandHeldSmoother({.expert = {.node_s = 0.0}}), InvalidParams);
  EXPECT_THROW(HandHeldSmoother({.hand_sigma_m_s2 = std::numeric_limits<double>::quiet_NaN()}), InvalidParams);
}

}  // namespace
}  // namespace tumble
