// SPDX-License-Identifier: BSD-3-Clause
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

namespace tumble {
namespace {

constexpr double kNoise = 1e-3, kLevel = 8.7;

// Returns a spin that rises to 8.7 rad/s on y, stays for 40 samples and falls, while the other axes turn gently;
// `scatter` is that of the top readings.
std::vector<ImuSample> one_segment(double scatter) {
  oracles::Gaussian noise(5);
  std::vector<ImuSample> out(200);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double t = 0.01 * static_cast<double>(k), beyond = std::abs(t - 1.0) - 0.2;
    out[k].time_ns = static_cast<TimeNs>(10'000'000 * k);
    const bool top = beyond <= 0.0;
    const double y = top ? kLevel + scatter * noise() : kLevel - 9.0 * beyond + kNoise * noise();
    out[k].angular_velocity_rad_s = {2.0 * std::sin(3.0 * t) + kNoise * noise(), y,
                                     1.5 * std::cos(2.0 * t) + kNoise * noise()};
  }
  return out;
}

// A rate has noise: a single segment without noise is a saturation level, but with noise it may be a spin.
TEST(SaturationPlaneThickness, OneSegmentIsEnoughWhereItHasNoNoise) {
  const SaturationPlaneFinder finder{{}};
  const SaturationPlanes rail = finder.find(one_segment(1e-4)), spin = finder.find(one_segment(kNoise));
  ASSERT_TRUE(rail.sensing_axis[1].has_value());
  EXPECT_NEAR(rail.sensing_axis[1]->saturation_limit_rad_s, kLevel, 0.03);
  EXPECT_FALSE(rail.sensing_axis[0].has_value() || rail.sensing_axis[2].has_value());
  EXPECT_GT(rail.sensing_axis[1]->log_odds, 10.0);
  const double of_spin = spin.sensing_axis[1] ? spin.sensing_axis[1]->log_odds : 0.0;
  EXPECT_LT(of_spin, rail.sensing_axis[1]->log_odds - 10.0);
}

// A repeated reading has the neighbours of its first occurrence.
TEST(OtherReadings, StepOverRepeats) {
  std::vector<ImuSample> samples(5);
  const double rates[] = {1.0, 2.0, 2.0, 3.0, 3.0};
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].angular_velocity_rad_s.x() = rates[k];
  const std::vector<Neighbours> beside = neighbouring_readings(samples, Triad::gyro);
  ASSERT_EQ(beside.size(), 5u);
  EXPECT_EQ(beside[0].previous_sample, nullptr);
  EXPECT_EQ(beside[0].next_sample, &samples[1]);
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_EQ(beside[k].previous_sample, &samples[0]);
    EXPECT_EQ(beside[k].next_sample, &samples[3]);
  }
  for (const std::size_t k : {3u, 4u}) {
    EXPECT_EQ(beside[k].previous_sample, &samples[2]);
    EXPECT_EQ(beside[k].next_sample, nullptr);
  }
}

}  // namespace
}  // namespace tumble
