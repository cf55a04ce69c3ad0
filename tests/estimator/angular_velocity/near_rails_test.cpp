// SPDX-License-Identifier: BSD-3-Clause
// Tests readings that are unsaturated, but whose windows may have been partly saturated.
#include "estimator/src/angular_velocity/possible_saturation.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

constexpr double kRail_rad_s = 7.3, kWindow_s = 0.01, kTolerance_rad_s = 0.01;

// Returns the saturation plane of element x, observed on both sides, with a tilt towards z.
SaturationPlanes planes(double slope = -0.02) {
  SaturationPlane plane;
  plane.row = Vector3d(1.0, 0.0, slope);
  plane.saturation_limit_rad_s = kRail_rad_s;
  plane.samples = {20, 20};
  plane.tolerance_rad_s = kTolerance_rad_s;
  SaturationPlanes out;
  out.sensing_axis[0] = plane;
  return out;
}

struct Twirl {
  std::vector<ImuSample> samples;
  std::vector<double> expected_deficit_rad_s;  // saturation deficit of each window
};

// Returns means over windows of a rate about x that swings with `amplitude` at the given frequency; each is logged
// `times` times.
Twirl twirl(double amplitude_rad_s, double hz, int times = 1) {
  constexpr int kParts = 200;
  constexpr double kTwoPi = 6.283185307179586;
  Twirl out;
  for (int k = 0; k < 400; ++k) {
    double read = 0.0, whole = 0.0;
    for (int i = 0; i < kParts; ++i) {
      const double rate = amplitude_rad_s * std::sin(kTwoPi * hz * kWindow_s * (k + (i + 0.5) / kParts));
      read += std::clamp(rate, -kRail_rad_s, kRail_rad_s) / kParts;
      whole += rate / kParts;
    }
    for (int i = 0; i < times; ++i) {
      ImuSample sample;
      sample.angular_velocity_rad_s = Vector3d(read, 0.0, 0.0);
      out.samples.push_back(sample);
      out.expected_deficit_rad_s.push_back(std::abs(whole - read));
    }
  }
  return out;
}

// A partly saturated window reads too little: each such window is marked, and few others.
TEST(PartlySaturatedWindows, EachWindowThatIsPartlySaturatedIsReported) {
  for (const double hz : {0.7, 1.3, 2.9, 5.3}) {
    for (const int times : {1, 2}) {
      const Twirl motion = twirl(9.0, hz, times);
      const SaturationPlanes known = planes();
      const std::vector<std::uint8_t> near = possible_partial_saturation(motion.samples, known);
      std::size_t in_part = 0, told = 0, besides = 0;
      for (std::size_t k = 0; k < near.size(); ++k) {
        const Vector3d& reading = motion.samples[k].angular_velocity_rad_s;
        if (known.sensing_axis[0]->is_saturated(reading, reading.x() < 0.0 ? -1 : 1)) continue;
        const bool lost = motion.expected_deficit_rad_s[k] > 1e-6;
        in_part += lost ? 1 : 0;
        told += lost && near[k] == 1 ? 1 : 0;
        besides += !lost && near[k] != 0 ? 1 : 0;
      }
      EXPECT_GT(in_part, 0u) << hz;
      EXPECT_EQ(told, in_part) << hz;
      // at most two on either side of a segment, and two segments per swing
      EXPECT_LE(besides, static_cast<std::size_t>(4.0 * times * (2.0 * hz * 4.0 + 1.0))) << hz;
    }
  }
}

// Motion well below the saturation level, or slowly close to it, is measured.
TEST(PartlySaturatedWindows, WhatStaysBelowTheRailIsMeasured) {
  const auto none = [](const std::vector<std::uint8_t>& near) {
    return std::all_of(near.begin(), near.end(), [](std::uint8_t bits) { return bits == 0; });
  };
  EXPECT_TRUE(none(possible_partial_saturation(twirl(0.96 * kRail_rad_s, 2.9).samples, planes())));
  EXPECT_TRUE(none(possible_partial_saturation(twirl(0.98 * kRail_rad_s, 0.2).samples, planes())));
  // control: a fast motion of equal height
  EXPECT_FALSE(none(possible_partial_saturation(twirl(0.98 * kRail_rad_s, 2.9).samples, planes())));
}

TEST(PartlySaturatedWindows, ASaturationLimitThatWasNotSeenIsNotMet) {
  const Twirl motion = twirl(9.0, 2.9);
  for (const std::uint8_t bits : possible_partial_saturation(motion.samples, {})) EXPECT_EQ(bits, 0);
  SaturationPlanes one_sided = planes();
  one_sided.sensing_axis[0]->samples = {0, 20};
  const std::vector<std::uint8_t> near = possible_partial_saturation(motion.samples, one_sided);
  int positive = 0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const bool negative = motion.samples[k].angular_velocity_rad_s.x() < 0.0;
    EXPECT_TRUE(near[k] == 0 || !negative) << k;
    positive += near[k];
  }
  EXPECT_GT(positive, 0);
}

// The distance is that to the plane, not to an axis-aligned level, because motion on other axes shifts the plane.
TEST(PartlySaturatedWindows, TheRailIsThePlane) {
  std::vector<ImuSample> samples(3);
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].angular_velocity_rad_s = Vector3d(k == 1 ? 7.0 : 6.5, 0.0, 4.0);
  EXPECT_EQ(possible_partial_saturation(samples, planes(-0.01))[1], 1);
  EXPECT_EQ(possible_partial_saturation(samples, planes(-0.1))[1], 0);
}

}  // namespace
}  // namespace tumble
