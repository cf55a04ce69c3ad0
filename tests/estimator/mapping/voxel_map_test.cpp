// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/voxel_map.hpp"

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"

namespace tumble {
namespace {

Eigen::Vector3f random_point(std::uint64_t i, float edge) {
  return edge * Eigen::Vector3f(static_cast<float>(test::uniform(3 * i)) - 0.5f,
                                static_cast<float>(test::uniform(3 * i + 1)) - 0.5f,
                                static_cast<float>(test::uniform(3 * i + 2)) - 0.5f);
}

std::vector<float> brute_force(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query, int k,
                               float radius) {
  std::vector<float> distances;
  for (const Eigen::Vector3f& p : points) {
    const float ex = p.x() - query.x(), ey = p.y() - query.y(), ez = p.z() - query.z();
    const float d2 = ex * ex + ey * ey + ez * ez;
    if (d2 <= radius * radius) distances.push_back(d2);
  }
  std::sort(distances.begin(), distances.end());
  if (distances.size() > static_cast<std::size_t>(k)) distances.resize(static_cast<std::size_t>(k));
  return distances;
}

struct Density {
  int points;
  float edge_m;
  double voxel_m;
  float radius_m;
};
class NeighbourSearch : public testing::TestWithParam<Density> {};

TEST_P(NeighbourSearch, AgreesWithBruteForce) {
  const Density d = GetParam();
  VoxelMap map({d.voxel_m, 0.0});
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < d.points; ++i) {
    points.push_back(random_point(static_cast<std::uint64_t>(i), d.edge_m));
    ASSERT_TRUE(map.insert(points.back(), 0.02f, 7));
  }
  ASSERT_EQ(map.size(), points.size());
  NearestNeighbours found;
  std::size_t seen = 0;
  for (std::uint64_t q = 0; q < 200; ++q) {
    const Eigen::Vector3f query = random_point(1'000'000 + q, 1.2f * d.edge_m);
    const std::vector<float> expected = brute_force(points, query, 8, d.radius_m);
    map.nearest(query, 8, d.radius_m, found);
    ASSERT_EQ(static_cast<std::size_t>(found.count), expected.size()) << "query " << q;
    for (int i = 0; i < found.count; ++i) {
      // exact: the same three products and two sums in the same order
      EXPECT_EQ(found.distance2_m2[i], expected[static_cast<std::size_t>(i)]);
      EXPECT_EQ((map.position_W_m(found.index[i]) - query).squaredNorm() > 2.0f * d.radius_m * d.radius_m, false);
      EXPECT_EQ(map.sweep(found.index[i]), 7u);
    }
    seen += expected.size();
  }
  EXPECT_GT(seen, 100u);  // the comparison covered enough points
}

INSTANTIATE_TEST_SUITE_P(Densities, NeighbourSearch,
                         testing::Values(Density{4000, 6.0f, 0.5, 1.0f}, Density{300, 10.0f, 0.5, 1.0f},
                                         Density{5000, 2.0f, 0.5, 1.0f}, Density{2000, 6.0f, 1.0, 1.0f},
                                         Density{2000, 6.0f, 0.3, 2.0f}),
                         [](const auto& test) { return "n" + std::to_string(test.index); });

/// The registration relies on this when it searches again: a radius that contains all neighbours leaves them unchanged.
TEST(VoxelMap, FindsTheSameWithinANarrowerRadiusThatHoldsThem) {
  VoxelMap map({0.5, 0.0});
  for (std::uint64_t i = 0; i < 4000; ++i) ASSERT_TRUE(map.insert(random_point(i, 5.0f), 0.02f, 0));
  NearestNeighbours before, wide, narrow;
  for (std::uint64_t q = 0; q < 500; ++q) {
    const Eigen::Vector3f from = random_point(2'000'000 + q, 4.0f);
    const Eigen::Vector3f to = from + random_point(3'000'000 + q, 0.4f);
    map.nearest(from, 12, 1.0f, before);
    ASSERT_EQ(before.count, 12);
    map.nearest(to, 12, 1.0f, wide);
    const float reach_m = 1.0001f * (std::sqrt(before.distance2_m2[11]) + (to - from).norm());
    map.nearest(to, 12, std::min(reach_m, 1.0f), narrow);
    ASSERT_EQ(narrow.count, wide.count);
    for (int i = 0; i < wide.count; ++i) ASSERT_EQ(narrow.index[i], wide.index[i]) << "query " << q;
  }
}

TEST(SpatialHash, HoldsWhatAMapHolds) {
  SpatialHash hash(16);
  std::map<std::uint64_t, std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    // a crowded surface about the origin, so that keys of either sign share blocks
    const Eigen::Vector3i cube = random_point(i, 120.0f).cast<int>().cwiseProduct(Eigen::Vector3i(1, 1, 0)) +
                                 Eigen::Vector3i(0, 0, static_cast<int>(i % 3) - 1);
    const std::uint64_t key = SpatialHash::key(cube);
    ASSERT_EQ(hash.insert(key, i), expected.emplace(key, i).first->second);
  }
  ASSERT_EQ(hash.size(), expected.size());
  EXPECT_LT(expected.size(), 20'000u);
  for (const auto& [key, value] : expected) ASSERT_EQ(hash.find(key), value);
  EXPECT_EQ(hash.find(SpatialHash::key({500, 0, 0})), SpatialHash::kAbsentEntry);
}

TEST(VoxelMap, KeepsOnePointPerCubeOfTheSpacing) {
  VoxelMap map({0.5, 0.1});
  EXPECT_TRUE(map.insert({0.01f, 0.01f, 0.01f}, 0.1f, 0));
  EXPECT_FALSE(map.insert({0.09f, 0.09f, 0.09f}, 0.1f, 0));
  EXPECT_TRUE(map.insert({0.11f, 0.01f, 0.01f}, 0.1f, 0));
  EXPECT_TRUE(map.insert({-0.01f, 0.01f, 0.01f}, 0.1f, 0));  // cells around zero are not merged
  EXPECT_EQ(map.size(), 3u);
}

TEST(VoxelMap, RefusesWhatIsNotAPosition) {
  VoxelMap map({0.5, 0.1});
  EXPECT_FALSE(map.insert({std::numeric_limits<float>::quiet_NaN(), 0, 0}, 0.1f, 0));
  EXPECT_FALSE(map.insert({0, std::numeric_limits<float>::infinity(), 0}, 0.1f, 0));
  EXPECT_FALSE(map.insert({0, 0, 1e9f}, 0.1f, 0));
  EXPECT_EQ(map.size(), 0u);
  NearestNeighbours found;
  map.nearest({std::numeric_limits<float>::quiet_NaN(), 0, 0}, 8, 1.0f, found);
  EXPECT_EQ(found.count, 0);
}

TEST(VoxelMap, CopiesAreIndependent) {
  VoxelMap map({0.5, 0.0});
  ASSERT_TRUE(map.insert({1, 2, 3}, 0.1f, 0));
  VoxelMap copy = map;
  ASSERT_TRUE(copy.insert({1, 2, 3.1f}, 0.1f, 0));
  EXPECT_EQ(map.size(), 1u);
  EXPECT_EQ(copy.size(), 2u);
}

TEST(VoxelMap, ThrowsOnBadParams) {
  EXPECT_THROW(VoxelMap({0.0, 0.0}), InvalidParams);
  EXPECT_THROW(VoxelMap({0.5, 0.6}), InvalidParams);
}

NearestNeighbours all_of(const VoxelMap& map, const Eigen::Vector3f& at) {
  NearestNeighbours found;
  map.nearest(at, NearestNeighbours::kMaxNeighbours, 2.0f, found);
  return found;
}

TEST(PlaneFit, FindsATiltedPlane) {
  VoxelMap map({0.5, 0.0});
  const Eigen::Vector3f n = Eigen::Vector3f(0.3f, -0.5f, 0.8f).normalized();
  const Eigen::Vector3f u = n.unitOrthogonal(), v = n.cross(u), p(3.0f, -2.0f, 1.0f);
  for (std::uint64_t i = 0; i < 12; ++i) {
    const Eigen::Vector3f r = random_point(i, 0.6f);
    ASSERT_TRUE(map.insert(p + r.x() * u + r.y() * v, 0.02f, 0));
  }
  const PlaneFit fit = fit_plane(map, all_of(map, p), PlaneFitBounds{});
  ASSERT_EQ(fit.verdict, PlaneVerdict::plane);
  EXPECT_NEAR(std::abs(fit.normal_W.dot(n)), 1.0f, 1e-5f);  // single precision of the input; measured 1e-7
  EXPECT_NEAR(n.dot(fit.plane_centre_W_m - p), 0.0f, 1e-5f);
}

TEST(PlaneFit, RefusesALineABlobAndAHandful) {
  VoxelMap line({0.5, 0.0}), blob({0.5, 0.0}), few({0.5, 0.0});
  for (std::uint64_t i = 0; i < 12; ++i) {
    const Eigen::Vector3f r = random_point(i, 1.0f);
    line.insert({r.x(), 0.02f * r.y(), 0.02f * r.z()}, 0.02f, 0);
    blob.insert(r, 0.02f, 0);
    if (i < 4) few.insert({r.x(), r.y(), 0.0f}, 0.02f, 0);
  }
  EXPECT_EQ(fit_plane(line, all_of(line, {0, 0, 0}), PlaneFitBounds{}).verdict, PlaneVerdict::collinear);
  EXPECT_EQ(fit_plane(blob, all_of(blob, {0, 0, 0}), PlaneFitBounds{}).verdict, PlaneVerdict::plane_too_thick);
  EXPECT_EQ(fit_plane(few, all_of(few, {0, 0, 0}), PlaneFitBounds{}).verdict, PlaneVerdict::too_few_points);
}

TEST(PlaneFit, RefusesPointsThatCoincide) {
  VoxelMap map({0.5, 0.0});
  for (int i = 0; i < 8; ++i) map.insert({1.0f, 1.0f, 1.0f}, 0.02f, 0);
  EXPECT_EQ(fit_plane(map, all_of(map, {1, 1, 1}), PlaneFitBounds{}).verdict, PlaneVerdict::collinear);
}

TEST(VoxelMap, TakesBackTheNewestSweepsAndKeepsTheOthersAsTheyWere) {
  VoxelMap all({0.5, 0.1}), older({0.5, 0.1});
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const auto sweep = static_cast<std::uint32_t>(i / 600);
    all.insert(random_point(i, 6.0f), 0.01f, sweep, 40);
    if (sweep < 3) older.insert(random_point(i, 6.0f), 0.01f, sweep, 40);
  }
  const Eigen::Vector3f place = all.position_W_m(0) + Eigen::Vector3f::Constant(1e-3f);
  ASSERT_TRUE(all.move(0, place) && older.move(0, place));
  ASSERT_GT(all.size(), older.size());
  all.remove_sweeps_from(3);
  EXPECT_EQ(all.size(), older.size());
  NearestNeighbours of_all, of_older;
  for (std::uint64_t q = 0; q < 100; ++q) {
    const Eigen::Vector3f query = random_point(1'000'000 + q, 6.0f);
    all.nearest(query, 8, 1.0f, of_all);
    older.nearest(query, 8, 1.0f, of_older);
    ASSERT_EQ(of_all.count, of_older.count);
    for (int k = 0; k < of_all.count; ++k) {
      const auto n = static_cast<std::size_t>(k);
      EXPECT_EQ(of_all.distance2_m2[n], of_older.distance2_m2[n]);
      EXPECT_EQ(all.sweep(of_all.index[n]), older.sweep(of_older.index[n]));
    }
  }
  const std::uint32_t taken_back = 3;
  for (std::uint32_t index = 0; index < all.index_end(); ++index)
    EXPECT_TRUE(!all.exists(index) || all.sweep(index) < taken_back);
}

TEST(VoxelMap, CountsWhatIsSeenThroughAndKeepsTheCount) {
  VoxelMap map({0.5, 0.1});
  for (std::uint64_t i = 0; i < 400; ++i) map.insert(random_point(i, 6.0f), 0.01f, i < 200 ? 0 : 1);
  const std::uint32_t marked_at = 16;  // the first of a chunk
  const Eigen::Vector3f marked = map.position_W_m(marked_at), other = map.position_W_m(0);
  ASSERT_TRUE(map.exists(marked_at) && map.sweep(marked_at) == 0);
  map.count_observation(marked_at, false);
  EXPECT_EQ(map.seen_through_count(marked_at), 0);
  for (int k = 0; k < 300; ++k) map.count_observation(marked_at, true);
  EXPECT_EQ(map.seen_through_count(marked_at), 255);
  map.count_observation(marked_at, false);

  const auto count_at = [](const VoxelMap& given, const Eigen::Vector3f& place) {
    NearestNeighbours found;
    given.nearest(place, 1, 1e-4f, found);
    return found.count == 1 ? int{given.seen_through_count(found.index[0])} : -1;
  };
  VoxelMap older = map, near = map;
  older.remove_sweeps_from(1);
  near.remove_points_beyond(marked, 3.0f);
  for (const VoxelMap* one : {&map, &older, &near}) EXPECT_EQ(count_at(*one, marked), 254);
  EXPECT_EQ(count_at(map, other), 0);
}

}  // namespace
}  // namespace tumble
