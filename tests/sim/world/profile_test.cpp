// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/terrain/ground.hpp"
#include "sim/world/terrain/stairs.hpp"

namespace tumble::sim {
namespace {

TEST(SlopeProfile, IsLevelThenSteepThenLevel) {
  const SlopeProfile slope{-8.0, 0.5, 3.0, 0.1};
  EXPECT_NEAR(slope.length_m(), 3.0 / std::tan(0.5), 1e-12);
  EXPECT_NEAR(slope.height_m(-12.0), 0.0, 1e-6);
  EXPECT_NEAR(slope.height_m(5.0), -3.0, 1e-6);
  const double middle_m = -8.0 + 0.5 * slope.length_m();
  EXPECT_NEAR((slope.height_m(middle_m - 0.5) - slope.height_m(middle_m + 0.5)), std::tan(0.5), 1e-3);
}

TEST(LedgeProfile, DropsAsOftenAndAsDeepAsStated) {
  const LedgeProfile ledges{-8.0, 3, 1.5, 0.1, 2.0, 0.2};
  EXPECT_EQ(ledges.height_m(-8.0), 0.0);
  EXPECT_NEAR(ledges.height_m(-7.9), -1.5, 1e-12);
  EXPECT_NEAR(ledges.height_m(-5.9), -1.5 - 2.0 * std::tan(0.2), 1e-12);
  EXPECT_NEAR(ledges.height_m(-5.8), -3.0 - 2.0 * std::tan(0.2), 1e-12);
  EXPECT_NEAR(ledges.height_m(-8.0 + 3 * 2.1), -3 * (1.5 + 2.0 * std::tan(0.2)), 1e-12);
  EXPECT_NEAR(ledges.height_m(15.0), -3 * (1.5 + 2.0 * std::tan(0.2)), 1e-12);
}

TEST(Stairs, GoDownStepByStepWithoutGaps) {
  const Flight flight{-8.0, 12, 0.17, 0.29, 2.0};
  const std::vector<Step> steps = lay_steps(flight, 0.8);
  ASSERT_EQ(steps.size(), 12u);
  double x_m = -8.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(steps[i].centre_W_m.x() - steps[i].half_m.x(), x_m, 1e-12) << i;
    x_m = steps[i].centre_W_m.x() + steps[i].half_m.x();
    EXPECT_NEAR(steps[i].centre_W_m.z() + steps[i].half_m.z(), -0.17 * static_cast<double>(i + 1), 1e-12) << i;
  }
  EXPECT_NEAR(x_m, -8.0 + flight.length_m(), 1e-12);
  EXPECT_NEAR(std::tan(flight.slope_rad()), 0.17 / 0.29, 1e-12);
}

TEST(Ground, InterpolatesBetweenNodesAndEndsAtItsRim) {
  Ground ground(5, 2.0);
  ground.transform([](double x, double y, double) { return 2.0 * x - y; });
  EXPECT_NEAR(ground.height_m(0.3, -0.7), 1.3, 1e-12);
  EXPECT_NEAR(ground.height_m(2.0, 2.0), 2.0, 1e-12);
  EXPECT_NEAR(ground.height_m(50.0, -50.0), 6.0, 1e-12);
  ground.add_near(1.0, 1.0, 0.4, [](double, double) { return 1.0; });
  EXPECT_NEAR(ground.node_m(3, 3), 2.0, 1e-12);
  EXPECT_NEAR(ground.node_m(3, 4), 3.0, 1e-12) << "out of reach";
}

TEST(Fade, RisesFromNothingToAll) {
  EXPECT_EQ(fade(0.5, 0.7, 1.9), 0.0);
  EXPECT_NEAR(fade(1.3, 0.7, 1.9), 0.5, 1e-12);
  EXPECT_EQ(fade(2.0, 0.7, 1.9), 1.0);
}

}  // namespace
}  // namespace tumble::sim
