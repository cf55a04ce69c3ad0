// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/common/status.hpp"

namespace tumble {
namespace {

// x swings slowly beyond the saturation level, y stays below it, z is stationary; noise of an MTi-30
std::vector<ImuSample> swinging_run(double amplitude, double rail) {
  oracles::Gaussian noise(5);
  std::vector<ImuSample> run(600);
  for (std::size_t k = 0; k < run.size(); ++k) {
    const double phase = 0.03 * static_cast<double>(k);
    const Vector3d w(amplitude * std::sin(phase), 5.0 * std::cos(phase), 0.0);
    run[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    run[k].angular_velocity_rad_s = (w + 5e-3 * noise.vector()).cwiseMin(rail).cwiseMax(-rail);
    run[k].specific_force_m_s2 = Vector3d(0.0, 0.0, 9.81) + 6e-3 * noise.vector();
  }
  return run;
}

std::vector<Clipping> classify(const SaturationLimitDetector& rails, const std::vector<ImuSample>& run,
                               SaturationLimitDetector::State& state) {
  std::vector<Clipping> out(run.size());
  rails.classify_clipping_of_all(run, state, out);
  return out;
}

TEST(SaturationLimitDetector, FindsAPlateauThatNobodyStatedAndItsRaggedEdges) {
  const SaturationLimitDetector rails({});
  const std::vector<ImuSample> run = swinging_run(15.0, 10.5);
  SaturationLimitDetector::State state;
  const std::vector<Clipping> got = classify(rails, run, state);
  ASSERT_TRUE(rails.saturation_limit(state, 0).has_value());
  EXPECT_EQ(*rails.saturation_limit(state, 0), 10.5);
  EXPECT_FALSE(rails.saturation_limit(state, 3).has_value());
  std::size_t clipped = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const bool at_rail = std::abs(run[k].angular_velocity_rad_s.x()) == 10.5;
    clipped += at_rail;
    if (at_rail) {
      EXPECT_EQ(got[k].gyro, 1) << k;
    }
    if (std::abs(run[k].angular_velocity_rad_s.x()) < 0.97 * 10.5) {
      EXPECT_EQ(got[k].gyro, 0) << k;
    }
    EXPECT_EQ(got[k].unusable_gyro, 0);
  }
  EXPECT_GT(clipped, 200u);
}

TEST(SaturationLimitDetector, NoisyPeaksAreNoPlateau) {
  const SaturationLimitDetector rails({});
  SaturationLimitDetector::State state;
  for (const Clipping& c : classify(rails, swinging_run(9.0, 10.5), state)) EXPECT_EQ(c, Clipping{});
  for (int c = 0; c < 6; ++c) EXPECT_FALSE(rails.saturation_limit(state, c).has_value()) << c;
}

// Returns the saturation level found in a swing with the noise and quantisation of a device.
std::optional<double> rail_of(double amplitude, double rail, double noise_rad_s, double digit_rad_s) {
  oracles::Gaussian noise(7);
  const SaturationLimitDetector rails({});
  SaturationLimitDetector::State state;
  for (std::size_t k = 0; k < 3000; ++k) {
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(k) * 10'000'000;
    sample.specific_force_m_s2 = {0.0, 0.0, 9.81};
    double rate = amplitude * std::sin(0.05 * static_cast<double>(k)) + noise_rad_s * noise.vector().x();
    if (digit_rad_s > 0.0) rate = digit_rad_s * std::round(rate / digit_rad_s);
    sample.angular_velocity_rad_s.x() = std::clamp(rate, -rail, rail);
    rails.observe_reading(sample, state);
  }
  return rails.saturation_limit(state, 0);
}

TEST(SaturationLimitDetector, FindsAPlateauAtAnyLevel) {
  for (const double rail : {0.05, 0.1, 0.3, 0.9, 3.0}) {
    for (const double digit : {0.0, 1e-4}) {
      EXPECT_NEAR(rail_of(3.0 * rail, rail, 0.01 * rail, digit).value_or(0.0), rail, 1e-12) << rail << " " << digit;
    }
  }
}

// coarse quantisation makes the tops of slow swings flat, and a stationary axis is flat throughout
TEST(SaturationLimitDetector, WhatIsFlatByNatureIsNoPlateau) {
  for (const double amplitude : {0.03, 0.1, 0.5, 0.95}) {
    for (const double digit : {0.0, 1e-3, 5e-3}) {
      for (const double noise : {0.0, 1e-3, 5e-3}) {
        EXPECT_FALSE(rail_of(amplitude, 100.0, noise, digit).has_value()) << amplitude << " " << digit << " " << noise;
      }
    }
  }
  const SaturationLimitDetector rails({});
  SaturationLimitDetector::State state;
  ImuSample dead;
  dead.angular_velocity_rad_s = {0.3, -0.04, 0.0};
  for (int k = 0; k < 100; ++k) rails.observe_reading(dead, state);
  for (int c = 0; c < 6; ++c) EXPECT_FALSE(rails.saturation_limit(state, c).has_value()) << c;
}

TEST(SaturationLimitDetector, ThePlateauOverrulesTheStatedRange) {
  for (double stated : {7.854, 12.0}) {  // below the largest reading, and above the plateau
    const SaturationLimitDetector rails({.stated_gyro_range_rad_s = stated});
    SaturationLimitDetector::State state;
    const std::vector<ImuSample> run = swinging_run(15.0, 10.5);
    classify(rails, run, state);
    EXPECT_EQ(rails.saturation_limit(state, 0).value_or(0.0), 10.5);
    EXPECT_TRUE(rails.disagrees(state, 0));
    EXPECT_EQ(rails.saturation_limit(state, 2).value_or(0.0),
              10.5);  // the axis at rest uses the limit of the other axis
    EXPECT_FALSE(rails.disagrees(state, 2));
  }
  const SaturationLimitDetector right({.stated_gyro_range_rad_s = 10.5});
  SaturationLimitDetector::State state;
  classify(right, swinging_run(15.0, 10.5), state);
  EXPECT_FALSE(right.disagrees(state, 0));
}

TEST(SaturationLimitDetector, TheStatedRangeServesUntilThereIsAPlateau) {
  const SaturationLimitDetector rails({.stated_gyro_range_rad_s = 10.5, .stated_accel_range_m_s2 = 49.0});
  SaturationLimitDetector::State state;
  EXPECT_EQ(rails.saturation_limit(state, 1).value_or(0.0), 10.5);
  EXPECT_EQ(rails.saturation_limit(state, 4).value_or(0.0), 49.0);
  ImuSample sample;
  sample.angular_velocity_rad_s = {-10.5, 10.4, 10.48};
  sample.specific_force_m_s2 = {49.0, -48.9, -48.0};
  const Clipping got = rails.classify_clipping(sample, state);
  EXPECT_EQ(got.gyro, 1 | 4);
  EXPECT_EQ(got.accel, 1 | 2);
}

TEST(SaturationLimitDetector, UsesTheFlagsOfTheDevice) {
  const SaturationLimitDetector rails({});
  SaturationLimitDetector::State state;
  ImuSample sample;
  sample.device_clip_flags = kClipGyroY | kClipAccelZ;
  const Clipping got = rails.classify_clipping(sample, state);
  EXPECT_EQ(got.gyro, 2);
  EXPECT_EQ(got.accel, 4);
}

TEST(SaturationLimitDetector, AFlipBetweenOppositeLimitsIsAnOverflow) {
  const SaturationLimitDetector rails({.stated_gyro_range_rad_s = 10.5});
  SaturationLimitDetector::State state;
  ImuSample sample;
  sample.angular_velocity_rad_s.x() = 10.5;
  EXPECT_EQ(rails.classify_clipping(sample, state).gyro, 1);
  sample.angular_velocity_rad_s.x() = -10.2;
  EXPECT_EQ(rails.classify_clipping(sample, state).unusable_gyro, 1);
  EXPECT_EQ(rails.classify_clipping(sample, state).gyro, 0);
  sample.angular_velocity_rad_s.x() = 10.5;
  EXPECT_EQ(rails.classify_clipping(sample, state).gyro, 1);
}

TEST(SaturationLimitDetector, RefusesParametersOutsideOfTheirBounds) {
  EXPECT_THROW(SaturationLimitDetector({.stated_gyro_range_rad_s = 0.0}), InvalidParams);
  EXPECT_THROW(SaturationLimitDetector({.stated_accel_range_m_s2 = std::nan("")}), InvalidParams);
}

}  // namespace
}  // namespace tumble
