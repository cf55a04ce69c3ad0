// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/pcl/map_cloud.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

TEST(Pcl, CarriesEveryFieldThereAndBack) {
  std::vector<MapPoint> points(3);
  points[0] = {{1, 2, 3}, {0, 0, 1}, 0.02f};
  points[1] = {{-4, 5.5f, 1e-3f}, {0, 0, 0}, 0.0f};
  points[2] = {{100, -200, 30}, Eigen::Vector3f(1, -1, 1).normalized(), 0.4f};
  const auto cloud = to_map_cloud(points);
  ASSERT_EQ(cloud.size(), points.size());
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_FLOAT_EQ(cloud[2].y, -200.0f);
  EXPECT_FLOAT_EQ(cloud[0].normal_z, 1.0f);
  EXPECT_FLOAT_EQ(cloud[2].intensity, 0.4f);
  const std::vector<MapPoint> back = from_map_cloud(cloud);
  ASSERT_EQ(back.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(back[i].position_W_m, points[i].position_W_m);
    EXPECT_EQ(back[i].normal_W, points[i].normal_W);
    EXPECT_EQ(back[i].sigma_m, points[i].sigma_m);
  }
  EXPECT_TRUE(from_map_cloud(to_map_cloud({})).empty());
}

}  // namespace
}  // namespace tumble
