// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/repeat_detector.hpp"

#include "tests/testing.hpp"
#include "tumble/common/status.hpp"

namespace tumble {
namespace {

constexpr double kSampling_s = 0.01, kGyroRail_rad_s = 5.0, kAccelRail_m_s2 = 40.0;

/// Returns noisy, clipped readings of a body. The body rests for two seconds, turns under pushes for four seconds, and
/// rests for four seconds.
std::vector<ImuSample> moving_body() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  std::vector<ImuSample> out;
  for (int k = 1; k <= 1000; ++k) {
    const double t = k * kSampling_s, moves = t > 2.0 && t < 6.0 ? 1.0 : 0.0;
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
    sample.angular_velocity_rad_s = moves * Eigen::Vector3d(3.0 * std::sin(4.0 * t), 2.0 * std::cos(5.0 * t),
                                                            9.0 * std::sin(0.5 * M_PI * (t - 2.0)));
    sample.specific_force_m_s2 = Eigen::Vector3d(0.0, 0.0, 9.81) +
                                 moves * Eigen::Vector3d(4.0 * std::sin(7.0 * t), 3.0 * std::sin(9.0 * t), 0.0);
    for (int j = 0; j < 3; ++j) {
      sample.angular_velocity_rad_s[j] += 0.005 * noise(random);
      sample.specific_force_m_s2[j] += 0.02 * noise(random);
    }
    out.push_back(sample);
  }
  return out;
}

std::vector<ImuSample> clipped_samples(std::vector<ImuSample> samples) {
  for (ImuSample& sample : samples)
    sample.angular_velocity_rad_s = sample.angular_velocity_rad_s.cwiseMax(-kGyroRail_rad_s).cwiseMin(kGyroRail_rad_s);
  return samples;
}

struct Found {
  std::string first;  ///< first verdict other than ok
  TimeNs told_ns = 0;
  FrozenAxes::State state;
};

Found watch_axes(const std::vector<ImuSample>& samples, const FrozenAxes::ImuRanges& imu_ranges) {
  const FrozenAxes detector(imu_ranges);
  Found out;
  for (const ImuSample& sample : samples) {
    detector.step(sample, out.state);
    SensorHealth health;
    detector.add_findings(HealthFinding::Kind::frozen_axis, "imu", out.state, health);
    EXPECT_EQ(health.ok(), !FrozenAxes::any_frozen(out.state));
    if (health.ok() || !out.first.empty()) continue;
    out.first = health.worst_status().message();
    out.told_ns = sample.time_ns;
  }
  return out;
}

FrozenAxes::ImuRanges stated_ranges() {
  return {.gyro_range_rad_s = kGyroRail_rad_s, .accel_range_m_s2 = kAccelRail_m_s2};
}

TEST(FrozenAxes, NamesAnAxisThatRepeatsOneReadingWhileTheOthersMove) {
  for (const FrozenAxes::ImuRanges& imu_ranges : {FrozenAxes::ImuRanges{}, stated_ranges()}) {
    EXPECT_EQ(watch_axes(clipped_samples(moving_body()), imu_ranges).first, "");
    std::vector<ImuSample> samples = clipped_samples(moving_body());
    for (std::size_t k = 300; k < samples.size(); ++k)
      samples[k].angular_velocity_rad_s.x() = samples[300].angular_velocity_rad_s.x();
    const Found found = watch_axes(samples, imu_ranges);
    EXPECT_NE(found.first.find("gyro x"), std::string::npos) << found.first;
    EXPECT_LT(found.told_ns, samples[300].time_ns + 600'000'000);
    const Eigen::Vector3d variance = FrozenAxes(imu_ranges).rate_variance_rad2_s2(samples[400].time_ns, found.state);
    EXPECT_GT(std::sqrt(variance.x()), kGyroRail_rad_s);
    EXPECT_EQ(variance.y(), 0.0);
    EXPECT_EQ(FrozenAxes(imu_ranges).rate_variance_rad2_s2(samples[299].time_ns, found.state).x(), 0.0);
  }
}

TEST(FrozenAxes, NamesAnAxisOfTheAccelerometer) {
  std::vector<ImuSample> samples = moving_body();
  for (std::size_t k = 300; k < samples.size(); ++k)
    samples[k].specific_force_m_s2.y() = samples[300].specific_force_m_s2.y();
  EXPECT_NE(watch_axes(samples, stated_ranges()).first.find("accel y"), std::string::npos);
}

TEST(FrozenAxes, AnAxisFarBelowAnotherReadingIsFrozenAndNotSaturated) {
  std::vector<ImuSample> samples = moving_body();
  for (std::size_t k = 200; k < samples.size(); ++k)
    samples[k].specific_force_m_s2.y() = samples[200].specific_force_m_s2.y();
  ASSERT_LT(samples[200].specific_force_m_s2.y(), -1.0) << "smallest reading so far";
  for (const FrozenAxes::ImuRanges& imu_ranges : {FrozenAxes::ImuRanges{}, stated_ranges()})
    EXPECT_NE(watch_axes(samples, imu_ranges).first.find("accel y"), std::string::npos);
}

// The element is flagged at its saturation level, while the output stays at another value.
TEST(FrozenAxes, AFlagMakesNoRailOfAReadingThatIsFarFromIt) {
  std::vector<ImuSample> samples = clipped_samples(moving_body());
  for (std::size_t k = 205; k < samples.size(); ++k) {
    if (samples[k].angular_velocity_rad_s.z() == kGyroRail_rad_s) samples[k].device_clip_flags = kClipGyroZ;
    samples[k].angular_velocity_rad_s.z() = samples[205].angular_velocity_rad_s.z();
  }
  ASSERT_LT(std::abs(samples[205].angular_velocity_rad_s.z()), 0.5 * kGyroRail_rad_s);
  EXPECT_NE(watch_axes(samples, stated_ranges()).first.find("gyro z"), std::string::npos);
}

TEST(FrozenAxes, ASensorWithoutNoiseAtRestIsNotFrozen) {
  std::vector<ImuSample> samples = moving_body();
  for (ImuSample& sample : samples) {
    if (sample.time_ns > 2'000'000'000 && sample.time_ns < 6'000'000'000) continue;
    sample.angular_velocity_rad_s.setZero();
    sample.specific_force_m_s2 = {0.0, 0.0, 9.81};
  }
  EXPECT_EQ(watch_axes(samples, {}).first, "");
}

TEST(FrozenAxes, OneThatIsReadMoreSlowlyIsNotFrozen) {
  std::vector<ImuSample> samples = moving_body();
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].angular_velocity_rad_s.x() = samples[k - k % 20].angular_velocity_rad_s.x();
  EXPECT_EQ(watch_axes(samples, {}).first, "");
}

TEST(FrozenAxes, WhatIsNoReadingIsPassedOver) {
  const FrozenAxes detector(stated_ranges());
  FrozenAxes::State state;
  for (const ImuSample& sample : clipped_samples(moving_body())) detector.step(sample, state);
  const FrozenAxes::State before = state;
  ImuSample nan = moving_body().back();
  nan.time_ns += 1;
  nan.angular_velocity_rad_s.x() = std::nan("");
  detector.step(nan, state);
  detector.step(moving_body().front(), state);
  EXPECT_EQ(state, before);
  EXPECT_THROW(FrozenAxes({.gyro_range_rad_s = -1.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble
