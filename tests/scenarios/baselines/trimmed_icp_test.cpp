// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/trimmed_icp.hpp"

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {
namespace {

VoxelMap map_of(const test::Room& room) {
  VoxelMap map({0.5, 0.05});
  test::Motion still;
  still.rest_s = 1e9;
  for (int place = 0; place < 9; ++place) {
    Isometry3d T = Eigen::Isometry3d::Identity();
    const int column = place % 3, row = place / 3;
    T.translation() = Vector3d(1.5 * (column - 1), 1.0 * (row - 1), 0.2 * place);
    T.linear() = so3::exp(0.7 * place * Vector3d(1.0, 0.5, 0.2)).toRotationMatrix();
    for (const LidarPoint& point : test::make_sweep(room, still, T, place)) {
      map.insert((T * point.position_L_m.cast<double>()).cast<float>(), 0.02f, 0);
    }
  }
  return map;
}

std::vector<TrimmedIcp::Point> sweep_of(const test::Room& room) {
  test::Motion still;
  still.rest_s = 1e9;
  const Isometry3d T(so3::exp({0.5, -0.4, 0.3}));
  std::vector<TrimmedIcp::Point> points;
  int k = 0;
  for (const LidarPoint& point : test::make_sweep(room, still, T, 40)) {
    if (k++ % 6 == 0) points.push_back({(T * point.position_L_m.cast<double>()).cast<float>(), 4e-4f});
  }
  return points;
}

TEST(TrimmedIcp, FindsAKnownPose) {
  TrimmedIcp icp(TrimmedIcp::Params{});
  Isometry3d prior(so3::exp({0.02, -0.02, 0.03}));
  prior.translation() = Vector3d(0.15, -0.1, 0.08);
  const auto result =
      icp.align(sweep_of(test::Room::box_with_pillars()), prior, map_of(test::Room::box_with_pillars()));
  ASSERT_EQ(result.verdict, RegistrationVerdict::converged);
  // the registration stops at steps of a centimetre and a milliradian
  EXPECT_LT(result.T.translation().norm(), 0.02);
  EXPECT_LT(Eigen::AngleAxisd(result.T.linear()).angle(), 2e-3);
}

TEST(TrimmedIcp, NoMatchesAndFarCorrectionsAreNoSuccess) {
  TrimmedIcp icp(TrimmedIcp::Params{});
  const auto points = sweep_of(test::Room::box());
  EXPECT_EQ(icp.align(points, Eigen::Isometry3d::Identity(), VoxelMap({0.5, 0.1})).verdict,
            RegistrationVerdict::too_few_matches);
  EXPECT_EQ(icp.align({}, Eigen::Isometry3d::Identity(), map_of(test::Room::box())).verdict,
            RegistrationVerdict::too_few_matches);
  TrimmedIcp::Params strict;
  strict.correction_max_m = 0.05;
  Isometry3d prior = Eigen::Isometry3d::Identity();
  prior.translation().x() = 0.3;
  TrimmedIcp bounded(strict);
  const auto result = bounded.align(points, prior, map_of(test::Room::box()));
  EXPECT_EQ(result.verdict, RegistrationVerdict::diverged);
  EXPECT_EQ(result.T.translation().x(), 0.3);  // the prior is unchanged
}

TEST(TrimmedIcp, ACorridorLooksLikeASuccess) {
  TrimmedIcp icp(TrimmedIcp::Params{});
  Isometry3d prior = Eigen::Isometry3d::Identity();
  prior.translation().x() = 0.4;
  const auto result = icp.align(sweep_of(test::Room::corridor()), prior, map_of(test::Room::corridor()));
  EXPECT_EQ(result.verdict, RegistrationVerdict::converged);  // the known error of the published chain, reproduced
}

// The test compares the published rule with a search over every share.
TEST(Trim, MinimisesItsCostWithinBounds) {
  std::vector<float> d2;
  for (int i = 0; i < 1000; ++i) {
    const double u = test::uniform(static_cast<std::uint64_t>(i));
    d2.push_back(static_cast<float>(i < 580 ? 1e-4 * u : 0.5 + u));
  }
  std::sort(d2.begin(), d2.end());
  TrimmedIcp::Params params;
  const std::size_t kept = TrimmedIcp::trim(d2, d2.size(), params);
  EXPECT_EQ(kept, 580u);
  params.trim_max = 0.55;
  EXPECT_EQ(TrimmedIcp::trim(d2, d2.size(), params), 550u);
}

TEST(Trim, UnmatchedSlotsInTheCountReachPastTheData) {
  const std::vector<float> d2(600, 1.0f);  // 400 of 1000 slots have no match
  TrimmedIcp::Params params;
  const std::size_t rightly = TrimmedIcp::trim(d2, d2.size(), params);
  EXPECT_LE(rightly, 420u);
  // with a share of all launched points, 0.7 would be the 700th of 600 entries: the index is limited to the end, so all
  // matches remain
  EXPECT_EQ(TrimmedIcp::trim(d2, 1000, params), 600u);
  EXPECT_EQ(TrimmedIcp::trim({}, 1000, params), 0u);
}

}  // namespace
}  // namespace tumble::baselines
