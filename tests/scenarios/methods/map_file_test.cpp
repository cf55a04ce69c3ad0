// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/map_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/temporary_folder.hpp"

namespace tumble::scenarios {
namespace {

using MapFile = testing::TemporaryFolder;

std::vector<MapPoint> some_map() {
  std::vector<MapPoint> map(500);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const float x = 0.37f * static_cast<float>(k);
    map[k] = {{x, -1.0f / (1.0f + x), 1e-6f * x}, Eigen::Vector3f(std::sin(x), 0.0f, std::cos(x)), 0.001f * x};
  }
  map[7].normal_W.setZero();
  return map;
}

void expect_equal(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].position_W_m, b[k].position_W_m) << k;
    ASSERT_EQ(a[k].normal_W, b[k].normal_W) << k;
    ASSERT_EQ(a[k].sigma_m, b[k].sigma_m) << k;
  }
}

TEST_F(MapFile, PlyGivesBackEveryBit) {
  const std::vector<MapPoint> map = some_map();
  write_map(folder_ / "map.ply", map);
  expect_equal(read_map(folder_ / "map.ply"), map);
}

}  // namespace
}  // namespace tumble::scenarios
