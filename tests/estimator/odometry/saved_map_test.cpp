// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/tumbling_odometry.hpp"

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

std::vector<MapPoint> some_points() {
  std::vector<MapPoint> points;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const auto number = [&](std::uint64_t i) { return static_cast<float>(10.0 * test::uniform(7 * k + i) - 5.0); };
    MapPoint& point = points.emplace_back();
    point.position_W_m = {number(0), number(1), number(2)};
    if (k % 5 != 0) point.normal_W = Eigen::Vector3f(number(3), number(4), number(5)).normalized();
    point.sigma_m = std::abs(number(6));
  }
  return points;
}

bool same(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].position_W_m != b[k].position_W_m || a[k].normal_W != b[k].normal_W || a[k].sigma_m != b[k].sigma_m)
      return false;
  }
  return true;
}

TEST(SavedMap, ALoadedMapIsEqualAndSavesToEqualBytes) {
  const std::vector<std::byte> bytes = save_map(some_points());
  EXPECT_EQ(bytes.size(), 40u + 8u + 28u * some_points().size());
  std::vector<MapPoint> points;
  const Status status = load_map(bytes, points);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_TRUE(same(points, some_points()));
  EXPECT_EQ(save_map(points), bytes);
}

TEST(SavedMap, AnEmptyMapIsAMap) {
  std::vector<MapPoint> points = some_points();
  ASSERT_TRUE(load_map(save_map({}), points).ok());
  EXPECT_TRUE(points.empty());
}

TEST(SavedMap, EveryTruncationIsRefused) {
  const std::vector<std::byte> bytes = save_map(some_points());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    std::vector<MapPoint> points = some_points();
    ASSERT_EQ(load_map(std::span(bytes).first(length), points).error_code, ErrorCode::insufficient_data) << length;
    ASSERT_TRUE(same(points, some_points())) << length;
  }
}

TEST(SavedMap, EveryChangedByteIsRefused) {
  std::vector<std::byte> bytes = save_map(some_points());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    bytes[at] ^= std::byte{0x10};
    std::vector<MapPoint> points;
    ASSERT_FALSE(load_map(bytes, points).ok()) << at;
    ASSERT_TRUE(points.empty()) << at;
    bytes[at] ^= std::byte{0x10};
  }
}

/// The checksum of these bytes is correct; only their values are impossible.
TEST(SavedMap, ImpossibleValuesAreRefused) {
  const auto refused = [](auto change) {
    std::vector<MapPoint> points = some_points();
    change(points[7]);
    std::vector<MapPoint> loaded;
    return load_map(save_map(points), loaded);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refused([&](MapPoint& point) { point.position_W_m.y() = nan; }).error_code, ErrorCode::non_finite);
  EXPECT_EQ(refused([&](MapPoint& point) { point.normal_W.x() = nan; }).error_code, ErrorCode::non_finite);
  EXPECT_EQ(refused([&](MapPoint& point) { point.sigma_m = nan; }).error_code, ErrorCode::non_finite);
  EXPECT_EQ(refused([](MapPoint& point) { point.sigma_m = -0.1f; }).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(refused([](MapPoint& point) { point.normal_W = {0.0f, 0.5f, 0.0f}; }).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(refused([](MapPoint& point) { point.position_W_m.x() = 1e6f; }).error_code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace tumble
