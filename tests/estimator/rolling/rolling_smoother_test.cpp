// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_smoother.hpp"

#include "estimator/rolling/lagged_params.hpp"
#include "estimator/rolling/rolling_truth.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::kLeverArm;

/// Returns an L of 2 m with 0.8 s of slip by `slip_m`, measured by sensors without errors.
testing::RollingTruth seen_exactly(const Eigen::Vector3d& lever_arm_m,
                                   const Eigen::Vector3d& slip_m = {-0.25, 0.0125, 0.0}) {
  return testing::roll({.velocity_m_s = testing::l_shape,
                        .contact_velocity_m_s = [&slip_m](double t) -> Eigen::Vector3d {
                          return testing::minimum_jerk_speed(t, 2.8, 0.8, 1.0) * slip_m;
                        },
                        .lever_arm_m = lever_arm_m,
                        .q_start = so3::exp({0.1, -0.2, 0.0})});
}

/// Returns this path with constant errors of gyro and accelerometer of the Phidget class.
testing::RollingTruth slipping() {
  testing::RollingTruth truth = seen_exactly(kLeverArm);
  for (ImuSample& sample : truth.samples) {
    sample.angular_velocity_rad_s += Eigen::Vector3d(3e-4, -2e-4, 4e-4) + 2e-3 * sample.angular_velocity_rad_s;
    sample.specific_force_m_s2 += Eigen::Vector3d(0.03, -0.02, 0.04);
  }
  return truth;
}

std::vector<RollingEstimate> smoothed_truth(const testing::RollingTruth& truth, double lag_s) {
  const RollingSmoother smoother(testing::lagged_params(lag_s));
  const auto state = std::make_unique<RollingSmoother::State>();
  std::vector<RollingEstimate> out;
  for (const ImuSample& sample : truth.samples) EXPECT_TRUE(smoother.step(sample, *state, out).ok());
  smoother.finish(*state, out);
  return out;
}

TEST(RollingSmoother, OneEstimateForEachSampleWithWholeRunAndWithLag) {
  const testing::RollingTruth truth = slipping();
  for (const double lag_s : {RollingSmoother::kWholeRecordingLag, 2.0, 0.5}) {
    const std::vector<RollingEstimate> out = smoothed_truth(truth, lag_s);
    ASSERT_EQ(out.size(), truth.samples.size()) << lag_s;
    for (std::size_t k = 0; k < out.size(); ++k) ASSERT_EQ(out[k].time_ns, truth.samples[k].time_ns) << lag_s;
    // 1 % of the path; measured 0.6 %: the scale error alone is 0.2 %
    EXPECT_LT((out.back().sphere_centre_W_m - truth.p_WG_m.back()).norm(), 0.02) << lag_s;
  }
}

TEST(RollingSmoother, MendsThePathInsideAnEvent) {
  const testing::RollingTruth truth = slipping();
  const std::vector<RollingEstimate> whole = smoothed_truth(truth, RollingSmoother::kWholeRecordingLag);
  const RollingFilter filter(testing::lagged_params(1.0).filter);
  const auto state = std::make_unique<RollingFilter::State>();
  double live = 0.0, smoothed = 0.0, in_event = 0.0;
  ASSERT_EQ(whole.size(), truth.samples.size());
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(filter.step(truth.samples[k], *state).ok());
    if (truth.gripping[k]) continue;
    live = std::max(live, (state->sphere_centre_W_m - truth.p_WG_m[k]).norm());
    smoothed = std::max(smoothed, (whole[k].sphere_centre_W_m - truth.p_WG_m[k]).norm());
    in_event += may_slip(whole[k].mode);
  }
  EXPECT_LT(smoothed, live);
  EXPECT_LT(smoothed, 0.01);
  EXPECT_GT(in_event, 0.5 * 0.8 / 0.004) << "the event was not seen at all";
}

/// Returns the same path with a random slip, and constant errors of gyro, accelerometer and lever arm drawn from the
/// filter's priors.
testing::RollingTruth drawn_path(std::uint64_t seed, const RollingParams& believed) {
  oracles::Gaussian normal(seed);
  const Eigen::Vector3d slip_m(-normal.uniform(0.1, 0.4), 0.02 * normal(), 0.0);
  testing::RollingTruth truth =
      seen_exactly(believed.lever_arm_m + believed.lever_arm_sigma_m * normal.vector(), slip_m);
  const Eigen::Vector3d gyro_bias = believed.expert.prior.gyro_bias_sigma_rad_s * normal.vector();
  const Eigen::Vector3d accel_bias = believed.expert.prior.accel_bias_sigma_m_s2 * normal.vector();
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Identity(), accel = Eigen::Matrix3d::Identity();
  for (double& entry : gyro.reshaped()) entry += believed.expert.prior.gyro_scale_sigma * normal();
  for (double& entry : accel.reshaped()) entry += believed.expert.prior.accel_scale_sigma * normal();
  for (ImuSample& sample : truth.samples) {
    sample.angular_velocity_rad_s = gyro * sample.angular_velocity_rad_s + gyro_bias;
    sample.specific_force_m_s2 = accel * sample.specific_force_m_s2 + accel_bias;
  }
  return truth;
}

/// Normalised contains the mean over draws of the squared position error over its reported covariance, per unknown: at
/// the end, and within the path after the lag.
struct Normalised {
  double within = 0.0, end = 0.0;
};

Normalised normalised_errors(double lag_s) {
  constexpr int kDraws = 16;
  constexpr std::size_t kWithin = 1500;  // 6 s: after the slip, within the second leg
  Normalised mean;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const testing::RollingTruth truth = drawn_path(seed, testing::lagged_params(1.0).filter);
    const std::vector<RollingEstimate> out = smoothed_truth(truth, lag_s);
    const auto add = [&](std::size_t k, double& sum) {
      const Eigen::Vector3d error = out[k].sphere_centre_W_m - truth.p_WG_m[k];
      const Eigen::Matrix3d covariance = out[k].covariance.topLeftCorner<3, 3>();
      sum += error.dot(covariance.llt().solve(error)) / (3.0 * kDraws);
    };
    add(kWithin, mean.within);
    add(out.size() - 1, mean.end);
  }
  return mean;
}

TEST(RollingSmoother, ItsCovarianceIsNeitherTooSmallNorTooLarge) {
  for (const double lag_s : {RollingSmoother::kWholeRecordingLag, 1.0}) {
    const Normalised mean = normalised_errors(lag_s);
    // 48 unknowns: a correct covariance gives 0.46 to 1.81 in 99.9 % of cases
    for (const double each : {mean.within, mean.end}) {
      EXPECT_GT(each, 0.46) << lag_s;
      EXPECT_LT(each, 1.81) << lag_s;
    }
  }
}

TEST(RollingSmoother, ErrorsLieWithinItsCovariance) {
  const testing::RollingTruth truth = slipping();
  for (const double lag_s : {RollingSmoother::kWholeRecordingLag, 1.0}) {
    const std::vector<RollingEstimate> out = smoothed_truth(truth, lag_s);
    int inside = 0, total = 0;
    for (std::size_t k = 600; k < out.size(); ++k) {
      const Eigen::Vector3d error = out[k].sphere_centre_W_m - truth.p_WG_m[k];
      for (int axis = 0; axis < 3; ++axis)
        inside += std::abs(error[axis]) <= 3.0 * std::sqrt(out[k].covariance(axis, axis));
      total += 3;
    }
    EXPECT_GE(inside, 0.99 * total) << lag_s;
  }
}

/// With a lag, the path before a rest has been reported, so what rest reveals about it must not move a stationary
/// sphere. The path stops from 4.5 to 5.5 s and from 8 s on.
TEST(RollingSmoother, WithALagAStandstillHasNoDrift) {
  const testing::RollingTruth truth = slipping();
  for (const double lag_s : {0.3, 1.0}) {
    const std::vector<RollingEstimate> out = smoothed_truth(truth, lag_s);
    ASSERT_EQ(out.size(), truth.samples.size());
    for (const auto& [from_s, to_s] : {std::pair(0.5, 1.9), std::pair(4.6, 5.4), std::pair(8.1, 10.0)}) {
      const auto first = static_cast<std::size_t>(from_s / 0.004), end = static_cast<std::size_t>(to_s / 0.004);
      for (std::size_t k = first; k < end; ++k)
        ASSERT_EQ(out[k].sphere_centre_W_m, out[first].sphere_centre_W_m) << lag_s << " " << k;
    }
    // and the position changes again when the motion continues
    for (std::size_t k = 0; k < out.size(); ++k)
      ASSERT_LT((out[k].sphere_centre_W_m - truth.p_WG_m[k]).norm(), 0.03) << k;
  }
}

/// A stationary sphere turns slowly about its contact, below the limits of rest: its rate is no bias, or the whole path
/// would rotate.
TEST(RollingSmoother, ASlowTurnAtTheEndIsNoBias) {
  const testing::RollingTruth still = slipping();
  testing::RollingTruth turning = still;
  for (std::size_t k = 0; k < turning.samples.size(); ++k) {
    if (seconds(turning.samples[k].time_ns) < 8.2) continue;  // the roll ends at 8.0 s
    turning.samples[k].angular_velocity_rad_s += turning.q_WI[k].conjugate() * Eigen::Vector3d(0.0, 0.0, 0.014);
  }
  const std::vector<RollingEstimate> without = smoothed_truth(still, RollingSmoother::kWholeRecordingLag);
  const std::vector<RollingEstimate> with = smoothed_truth(turning, RollingSmoother::kWholeRecordingLag);
  ASSERT_EQ(with.size(), without.size());
  EXPECT_TRUE(with.back().at_rest) << "the turn was not taken for rest at all";
  EXPECT_LT((with.back().sphere_centre_W_m - without.back().sphere_centre_W_m).norm(), 0.002);
  EXPECT_LT((with.back().sphere_centre_W_m - turning.p_WG_m.back()).norm(), 0.02);
}

/// The sphere is 2 % smaller than assumed: its accelerations determine the radius.
TEST(RollingSmoother, TheAccelerationsDetermineTheRadius) {
  constexpr double kAssumed_m = 0.148, kTrue_m = 0.145;
  const testing::RollingTruth truth = slipping();
  const auto smooth = [&](double radius_sigma_m) {
    RollingSmoother::Params params = testing::lagged_params(RollingSmoother::kWholeRecordingLag);
    params.filter.radius_m = kAssumed_m;
    params.filter.radius_sigma_m = radius_sigma_m;
    const RollingSmoother smoother(params);
    auto state = std::make_unique<RollingSmoother::State>();
    std::vector<RollingEstimate> out;
    for (const ImuSample& sample : truth.samples) EXPECT_TRUE(smoother.step(sample, *state, out).ok());
    smoother.finish(*state, out);
    EXPECT_EQ(out.size(), truth.samples.size());
    return state;
  };
  EXPECT_EQ(smooth(0.0)->constants.radius_error_m, 0.0);
  const auto unknown = smooth(0.007);
  EXPECT_NEAR(kAssumed_m + unknown->constants.radius_error_m, kTrue_m, 3.0 * unknown->radius_sigma_m);
  EXPECT_LT(unknown->radius_sigma_m, 1e-3);  // measured 0.7 mm
}

TEST(RollingSmoother, SplitRunsEqual) {
  const testing::RollingTruth truth = slipping();
  const RollingSmoother smoother(testing::lagged_params(0.5));
  const auto whole = std::make_unique<RollingSmoother::State>();
  std::vector<RollingEstimate> out_whole, out_split;
  constexpr std::size_t kCut = 901, kEnd = 1200;
  for (std::size_t k = 0; k < kEnd; ++k) ASSERT_TRUE(smoother.step(truth.samples[k], *whole, out_whole).ok());
  const auto first = std::make_unique<RollingSmoother::State>();
  for (std::size_t k = 0; k < kCut; ++k) ASSERT_TRUE(smoother.step(truth.samples[k], *first, out_split).ok());
  EXPECT_FALSE(*first == *whole);
  const auto second = std::make_unique<RollingSmoother::State>(*first);
  for (std::size_t k = kCut; k < kEnd; ++k) ASSERT_TRUE(smoother.step(truth.samples[k], *second, out_split).ok());
  EXPECT_TRUE(*second == *whole);
  ASSERT_EQ(out_split.size(), out_whole.size());
  ASSERT_FALSE(out_whole.empty());
  for (std::size_t k = 0; k < out_whole.size(); ++k)
    ASSERT_EQ(out_split[k].sphere_centre_W_m, out_whole[k].sphere_centre_W_m) << k;
}

TEST(RollingSmoother, RefusesBadParamsAndBadSamples) {
  EXPECT_THROW(RollingSmoother(testing::lagged_params(0.0)), InvalidParams);
  RollingSmoother::Params bad = testing::lagged_params(1.0);
  bad.rate_max_hz = -1.0;
  EXPECT_THROW(RollingSmoother{bad}, InvalidParams);
  const testing::RollingTruth truth = slipping();
  const RollingSmoother smoother(testing::lagged_params(1.0));
  const auto state = std::make_unique<RollingSmoother::State>();
  std::vector<RollingEstimate> out;
  for (std::size_t k = 0; k < 10; ++k) ASSERT_TRUE(smoother.step(truth.samples[k], *state, out).ok());
  const auto before = std::make_unique<RollingSmoother::State>(*state);
  EXPECT_EQ(smoother.step(truth.samples[5], *state, out).error_code, ErrorCode::time_order);
  ImuSample nan = truth.samples[10];
  nan.specific_force_m_s2.x() = std::nan("");
  EXPECT_EQ(smoother.step(nan, *state, out).error_code, ErrorCode::non_finite);
  EXPECT_TRUE(*state == *before);
}

}  // namespace
}  // namespace tumble
