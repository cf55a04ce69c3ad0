// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/rail.hpp"

#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kPeriod_s = 0.0005;

Rail rail(const Rail::Params& params, std::uint64_t seed = 1) {
  return {params, kPeriod_s, Stream(seed, "test")};
}

double x_of(Rail& rail, double input) {
  std::uint8_t flags = 0;
  return rail({input, 0, 0}, 0, flags).x();
}

TEST(RailStage, OffPassesEverythingBitForBit) {
  Rail off = rail({});
  std::uint8_t flags = 0;
  const Vector3d input(1e6, -1e6, 1.0 / 3.0);
  EXPECT_EQ(off(input, 0, flags), input);
  EXPECT_EQ(flags, 0);
}

TEST(RailStage, ClampsEachAxisAndFlagsIt) {
  Rail clamp = rail({.level = 10.5});
  std::uint8_t flags = 0;
  EXPECT_EQ(clamp({11.0, -10.6, 10.5}, 3, flags), Vector3d(10.5, -10.5, 10.5));
  EXPECT_EQ(flags, 0b011000);  // a value exactly at the saturation limit does not exceed it
}

TEST(RailStage, EveryKindLeavesWhatIsWithinTheRailAlone) {
  Rail each[] = {rail({.level = 10.0}), rail({.level = 10.0, .axis_spread = 0.3, .event_spread = 0.1}),
                 rail({.level = 10.0, .wrap = true}), rail({.level = 10.0, .recovery_s = 0.1, .recovery_share = 0.2})};
  for (Rail& kind : each) {
    for (double x = -8.5; x <= 8.5; x += 0.37) {
      std::uint8_t flags = 0;
      const Vector3d input(x, -x, 0.5 * x);
      ASSERT_EQ(kind(input, 0, flags), input);
      ASSERT_EQ(flags, 0);
    }
  }
}

TEST(RailStage, PlateauDiffersBetweenAxesAndSigns) {
  Rail plateau = rail({.level = 10.5, .axis_spread = 0.2});
  std::uint8_t flags = 0;
  const Vector3d high = plateau(Vector3d::Constant(20), 0, flags), low = plateau(Vector3d::Constant(-20), 0, flags);
  const std::set<double> levels = {high.x(), high.y(), high.z(), -low.x(), -low.y(), -low.z()};
  EXPECT_EQ(levels.size(), 6u);
  for (const double level : levels) EXPECT_NEAR(level, 10.5, 0.6 + 1e-12);  // limited to three standard deviations
  plateau(Vector3d::Zero(), 0, flags);
  EXPECT_EQ(plateau(Vector3d::Constant(30), 0, flags), high);  // the same in every event
  EXPECT_NE(rail({.level = 10.5, .axis_spread = 0.2}, 2)(Vector3d::Constant(20), 0, flags), high);
}

TEST(RailStage, PlateauDiffersFromOneClippingToTheNextAndKeepsWithinOne) {
  Rail plateau = rail({.level = 10.5, .event_spread = 0.1});
  std::set<double> levels;
  double sum = 0.0;
  constexpr int kEvents = 400;
  for (int event = 0; event < kEvents; ++event) {
    const double level = x_of(plateau, 13.0);
    // noise about the saturation level does not end a saturated period: 9.6 is above nine tenths of any level here
    for (const double x : {14.0, 9.8, 12.0, 15.0}) ASSERT_EQ(x_of(plateau, x), std::min(x, level)) << "event " << event;
    levels.insert(level);
    sum += level - 10.5;
    x_of(plateau, 3.0);
  }
  EXPECT_GT(levels.size(), static_cast<std::size_t>(kEvents) - 10);  // a few are limited to three standard deviations
  EXPECT_NEAR(sum / kEvents, 0.0, 5.0 * 0.1 / std::sqrt(kEvents));   // false alarm 6e-7
}

TEST(RailStage, WrapChangesTheSignAndLosesWholeTurns) {
  Rail wrap = rail({.level = 10.0, .wrap = true});
  EXPECT_NEAR(x_of(wrap, 10.5), -9.5, 1e-12);
  EXPECT_NEAR(x_of(wrap, -12.0), 8.0, 1e-12);
  EXPECT_NEAR(x_of(wrap, 31.0), -9.0, 1e-12);
  EXPECT_EQ(x_of(wrap, 10.0), 10.0);
  std::uint8_t flags = 0;
  wrap({0, 11, 0}, 0, flags);
  EXPECT_EQ(flags, 0b010);
}

TEST(RailStage, SlowRecoveryFadesWithItsTime) {
  Rail slow = rail({.level = 10.0, .recovery_s = 0.05, .recovery_share = 0.3});
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(x_of(slow, 12.0), 10.0);  // one second, until it is fully charged
  EXPECT_NEAR(x_of(slow, 1.0), 4.0, 1e-6);                           // 1 and 0.3 of the saturation limit
  for (int k = 1; k < 100; ++k) x_of(slow, 1.0);
  EXPECT_NEAR(x_of(slow, 1.0), 1.0 + 3.0 * std::exp(-1.0), 1e-6);  // 100 periods are one time constant
  for (int k = 0; k < 4000; ++k) x_of(slow, 1.0);
  EXPECT_NEAR(x_of(slow, 1.0), 1.0, 1e-12);
}

TEST(RailStage, SlowRecoveryGrowsWithTheLengthOfTheClippingAndHasItsSign) {
  const auto left_after = [](int steps) {
    Rail slow = rail({.level = 10.0, .recovery_s = 0.05, .recovery_share = 0.3});
    for (int k = 0; k < steps; ++k) x_of(slow, -12.0);
    return x_of(slow, 0.0);
  };
  EXPECT_NEAR(left_after(10), -3.0 * (1.0 - std::exp(-0.1)), 1e-9);
  EXPECT_NEAR(left_after(100), -3.0 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(RailStage, OffsetHoldsASignalBelowTheRailAtItAndFlagsIt) {
  Rail slow = rail({.level = 10.0, .recovery_s = 0.05, .recovery_share = 0.3});
  for (int k = 0; k < 2000; ++k) x_of(slow, 12.0);
  std::uint8_t flags = 0;
  EXPECT_EQ(slow({8.0, 0, 0}, 0, flags).x(), 10.0);
  EXPECT_EQ(flags, 0b001);
  for (int k = 0; k < 2000; ++k) x_of(slow, 8.0);  // the recovery does not keep itself active forever
  EXPECT_NEAR(x_of(slow, 8.0), 8.0, 1e-6);
}

}  // namespace
}  // namespace tumble::sim
