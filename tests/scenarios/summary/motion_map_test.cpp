// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/motion_map.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::size_t kCells = MotionMap::kCells;

DrawValues draw(const std::string& scenario, std::uint64_t seed, double rate, double force) {
  return {scenario, seed, {{"motion_peak_rate_rad_s", rate}, {"motion_peak_accel_m_s2", force}}};
}

double total(const MotionMap& map) {
  return std::accumulate(map.share.begin(), map.share.end(), 0.0);
}

TEST(MotionMap, OfOneDrawHasItsSummitThere) {
  const MotionMap map = motion_map(std::vector<DrawValues>{draw("hill", 1, 10.0, 100.0)});
  ASSERT_EQ(map.share.size(), kCells * kCells);
  EXPECT_NEAR(total(map), 1.0, 1e-12) << "every draw is somewhere";
  const auto summit =
      static_cast<std::size_t>(std::max_element(map.share.begin(), map.share.end()) - map.share.begin());
  const double step = std::log10(map.rate_rad_s[1] / map.rate_rad_s[0]);
  EXPECT_NEAR(std::log10(map.rate_rad_s[summit % kCells]), 1.0, 0.51 * step);
  EXPECT_NEAR(std::log10(map.force_m_s2[summit / kCells]), 2.0, 0.51 * step);
  // the kernel is a Gaussian of half a cell: the next cell has exp(-2) of the summit
  EXPECT_NEAR(map.share[summit + 1] / map.share[summit], std::exp(-2.0), 1e-9);
  EXPECT_NEAR(map.share[summit + kCells] / map.share[summit], std::exp(-2.0), 1e-9);
}

TEST(MotionMap, SharesAreThoseOfTheDraws) {
  // three of four draws lie together, far from the fourth
  const MotionMap map = motion_map(std::vector<DrawValues>{draw("hill", 1, 1.0, 10.0), draw("hill", 2, 1.0, 10.0),
                                                           draw("hill", 3, 1.0, 10.0), draw("roll", 1, 1e4, 10.0)});
  double slow = 0.0;
  for (std::size_t i = 0; i < map.share.size(); ++i) slow += map.rate_rad_s[i % kCells] < 100.0 ? map.share[i] : 0.0;
  EXPECT_NEAR(total(map), 1.0, 1e-12);
  EXPECT_GT(slow, 0.6);
  EXPECT_LT(slow, 0.8) << "0.75, but for what the wide kernel of four draws carries over";
  ASSERT_EQ(map.clouds.size(), 2u);
  EXPECT_EQ(map.clouds[0].draws, 3u);
  EXPECT_EQ(map.clouds[1].scenario, "roll");
}

TEST(MotionMap, LeavesOutWhatHasNoPlaceAmongLogarithms) {
  EXPECT_TRUE(motion_map(std::vector<DrawValues>{draw("hill", 1, 0.0, 10.0),
                                                 draw("hill", 2, 3.0, std::nan("")),
                                                 draw("hill", 3, INFINITY, 10.0),
                                                 {"hill", 4, {}, {}}})
                  .clouds.empty());
  EXPECT_TRUE(motion_map({}).share.empty());
}

TEST(MotionMap, ThinsItsPointsAndNotItsDensity) {
  std::vector<DrawValues> draws;
  for (std::uint64_t seed = 1; seed <= 1201; ++seed)
    draws.push_back(draw("hill", seed, 1.0 + 0.01 * static_cast<double>(seed), 50.0));
  const MotionMap map = motion_map(draws);
  ASSERT_EQ(map.clouds.size(), 1u);
  EXPECT_EQ(map.clouds[0].draws, 1201u);
  EXPECT_EQ(map.clouds[0].points.size(), 401u) << "every third";
  EXPECT_NEAR(total(map), 1.0, 1e-9);
}

TEST(MotionMap, HasThePublishedExtremesBesideIt) {
  const MotionMap map = motion_map(std::vector<DrawValues>{draw("hill", 1, 10.0, 100.0)});
  ASSERT_FALSE(map.extremes.empty());
  EXPECT_EQ(map.extremes[0].rate_rad_s, 18.6);
  EXPECT_EQ(map.extremes[0].force_m_s2, 157.8);
}

}  // namespace
}  // namespace tumble::scenarios
