// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/rolling/lagged_params.hpp"
#include "estimator/rolling/rolling_truth.hpp"
#include "tests/testing.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

// the IMU's rate, jitter and gaps: the same motion must give the same result
namespace tumble {
namespace {

using testing::kLeverArm;

Eigen::Vector3d spins(double t) {
  return {-testing::minimum_jerk_speed(t, 2.8, 0.8, 0.25), 0.05 * testing::minimum_jerk_speed(t, 2.8, 0.8, 0.25), 0.0};
}

/// Returns an L of 2 m with a phase of slip; errors of the Phidget class, noise of 4e-4 rad/s and 2e-3 m/s^2 per root
/// of Hz.
testing::RollingTruth slipping_sampled(TimeNs period_ns) {
  testing::RollingTruth truth = testing::roll({.velocity_m_s = testing::l_shape,
                                               .contact_velocity_m_s = spins,
                                               .lever_arm_m = kLeverArm,
                                               .q_start = so3::exp({0.1, -0.2, 0.0}),
                                               .period_ns = period_ns});
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const double wide = 1.0 / std::sqrt(seconds(period_ns));
  for (ImuSample& sample : truth.samples) {
    const Eigen::Vector3d a(normal(random), normal(random), normal(random)), b(normal(random), normal(random), 0.0);
    sample.angular_velocity_rad_s +=
        Eigen::Vector3d(3e-4, -2e-4, 4e-4) + 2e-3 * sample.angular_velocity_rad_s + 4e-4 * wide * a;
    sample.specific_force_m_s2 += Eigen::Vector3d(0.03, -0.02, 0.04) + 2e-3 * wide * b;
  }
  return truth;
}

struct Smoothed {
  std::vector<RollingEstimate> out;
  std::unique_ptr<RollingSmoother::State> state = std::make_unique<RollingSmoother::State>();
};

Smoothed smoothed_samples(const std::vector<ImuSample>& samples, const RollingSmoother::Params& p) {
  const RollingSmoother smoother(p);
  Smoothed run;
  for (const ImuSample& sample : samples) {
    const Status status = smoother.step(sample, *run.state, run.out);
    EXPECT_TRUE(status.ok()) << status.message();
  }
  smoother.finish(*run.state, run.out);
  EXPECT_EQ(run.out.size(), samples.size());
  return run;
}

double end_error_m(const std::vector<ImuSample>& samples, const Eigen::Vector3d& end_m, double lag_s) {
  return (smoothed_samples(samples, testing::lagged_params(lag_s)).out.back().sphere_centre_W_m - end_m).norm();
}

// 50 Hz to 8 kHz, and rates that are no divisors
constexpr TimeNs kPeriods_ns[] = {20'000'000, 8'000'000, 3'000'000, 1'000'000, 700'000, 250'000, 125'000};

// measured: 10 to 17 mm at every rate, whole and live, 14 mm at 250 Hz; the differences come from the noise
TEST(RollingRates, TheSameAnswerFrom50HzTo8kHz) {
  for (const TimeNs period_ns : kPeriods_ns) {
    const testing::RollingTruth truth = slipping_sampled(period_ns);
    const Smoothed own = smoothed_samples(truth.samples, testing::lagged_params(RollingSmoother::kWholeRecordingLag));
    const Eigen::Vector3d& end_m = truth.p_WG_m.back();
    EXPECT_LT((own.out.back().sphere_centre_W_m - end_m).norm(), 0.02) << period_ns;
    EXPECT_LT((own.state->live_filter.sphere_centre_W_m - end_m).norm(), 0.02) << period_ns;
  }
}

TEST(RollingRates, JitterOfTheStampsAndReadingsThatRepeatAreBorne) {
  const testing::RollingTruth truth = slipping_sampled(1'000'000);
  const Eigen::Vector3d& end_m = truth.p_WG_m.back();
  const double exact = end_error_m(truth.samples, end_m, RollingSmoother::kWholeRecordingLag);
  std::vector<ImuSample> position_constrained = truth.samples, jittered = slipping_sampled(4'000'000).samples;
  // a device with 200 Hz that is read at 1 kHz
  for (std::size_t k = 0; k < position_constrained.size(); ++k) {
    position_constrained[k].angular_velocity_rad_s = truth.samples[k - k % 5].angular_velocity_rad_s;
    position_constrained[k].specific_force_m_s2 = truth.samples[k - k % 5].specific_force_m_s2;
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> off(-1.5e6, 1.5e6);
  for (ImuSample& sample : jittered) sample.time_ns += static_cast<TimeNs>(off(random));
  const double of_held = end_error_m(position_constrained, end_m, RollingSmoother::kWholeRecordingLag),
               of_jittered = end_error_m(jittered, end_m, RollingSmoother::kWholeRecordingLag);
  EXPECT_LT(exact, 0.02);
  EXPECT_LT(of_held, 0.02);
  EXPECT_LT(of_jittered, 0.02);
}

TEST(RollingRates, SplitRunsEqualWithGaps) {
  std::vector<ImuSample> samples = slipping_sampled(1'000'000).samples;
  std::erase_if(samples, [](const ImuSample& s) { return s.time_ns > 4'200'000'000 && s.time_ns < 4'700'000'000; });
  for (const double lag_s : {0.5}) {
    const RollingSmoother smoother(testing::lagged_params(lag_s));
    const Smoothed whole = smoothed_samples(samples, testing::lagged_params(lag_s));
    for (const std::size_t cut : {4003UL, 4401UL, 5001UL}) {
      Smoothed split;
      for (std::size_t k = 0; k < cut; ++k) ASSERT_TRUE(smoother.step(samples[k], *split.state, split.out).ok());
      const auto carried = std::make_unique<RollingSmoother::State>(*split.state);
      for (std::size_t k = cut; k < samples.size(); ++k)
        ASSERT_TRUE(smoother.step(samples[k], *carried, split.out).ok());
      smoother.finish(*carried, split.out);
      ASSERT_EQ(split.out.size(), whole.out.size());
      EXPECT_TRUE(*carried == *whole.state) << cut;
      EXPECT_TRUE(split.out.back().sphere_centre_W_m == whole.out.back().sphere_centre_W_m) << cut;
    }
  }
}

TEST(RollingRates, AGapCostsAccuracyAndIsReported) {
  const testing::RollingTruth truth = slipping_sampled(4'000'000);
  const Eigen::Vector3d& end_m = truth.p_WG_m.back();
  const auto without = [&](double from_s, double length_s) {
    std::vector<ImuSample> samples = truth.samples;
    std::erase_if(samples, [&](const ImuSample& s) {
      return seconds(s.time_ns) > from_s && seconds(s.time_ns) < from_s + length_s;
    });
    return samples;
  };
  const auto sigma = [](const Smoothed& of) {
    return std::sqrt(of.out.back().covariance.topLeftCorner<3, 3>().trace());
  };
  const double whole = RollingSmoother::kWholeRecordingLag;
  const Smoothed none = smoothed_samples(truth.samples, testing::lagged_params(whole));
  EXPECT_EQ(none.state->live_filter.gaps, 0);
  for (const double length_s : {0.2, 0.95}) {
    for (const double lag_s : {whole, 0.5}) {
      const Smoothed moving = smoothed_samples(without(6.3, length_s), testing::lagged_params(lag_s));
      const double error = (moving.out.back().sphere_centre_W_m - end_m).norm();
      EXPECT_EQ(moving.state->live_filter.gaps, 1);
      EXPECT_LT(error, 3.0 * sigma(moving)) << length_s;
      EXPECT_LT(error, 0.3) << length_s;
      EXPECT_GT(sigma(moving), sigma(none)) << length_s;
    }
  }
  const Smoothed resting = smoothed_samples(without(0.8, 0.5), testing::lagged_params(whole));
  EXPECT_LT((resting.out.back().sphere_centre_W_m - end_m).norm(), 0.03);

  const RollingFilter filter(testing::lagged_params(1.0).filter);
  const auto state = std::make_unique<RollingFilter::State>();
  Status status;
  for (const ImuSample& sample : without(6.3, 1.1)) {
    status = filter.step(sample, *state);
    if (!status.ok()) break;
  }
  EXPECT_EQ(status.error_code, ErrorCode::gap);
  EXPECT_GT(status.value, 1.0);  // seconds
}

TEST(RollingRates, AStartInMotionIsReportedWithALargerCovariance) {
  const testing::RollingTruth truth = slipping_sampled(4'000'000);
  for (const double from_s : {2.4, 3.2, 6.7}) {
    std::vector<ImuSample> samples;
    std::size_t first = 0;
    for (std::size_t k = 0; k < truth.samples.size(); ++k) {
      if (seconds(truth.samples[k].time_ns) < from_s) continue;
      if (samples.empty()) first = k;
      samples.push_back(truth.samples[k]);
    }
    const Smoothed moving = smoothed_samples(samples, testing::lagged_params(RollingSmoother::kWholeRecordingLag));
    EXPECT_TRUE(moving.state->live_filter.started_in_motion);
    // heading and position of the start are those of the world: about its own heading, the path has equal length
    const Eigen::Quaterniond q = truth.q_WI[first] * moving.out.front().q_WI.conjugate();
    const Eigen::Quaterniond yaw = Eigen::Quaterniond(q.w(), 0.0, 0.0, q.z()).normalized();
    const Eigen::Vector3d path = truth.p_WG_m.back() - truth.p_WG_m[first];
    const Eigen::Vector3d error = yaw * moving.out.back().sphere_centre_W_m - path;
    const double sigma = std::sqrt(moving.out.back().covariance.topLeftCorner<3, 3>().trace());
    EXPECT_LT(error.norm(), 3.0 * sigma) << from_s;
  }
  EXPECT_FALSE(smoothed_samples(truth.samples, testing::lagged_params(RollingSmoother::kWholeRecordingLag))
                   .state->live_filter.started_in_motion);
}

}  // namespace
}  // namespace tumble
