// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/map_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {
namespace {

class MapFile : public ::testing::Test {
 protected:
  MapFile() { std::filesystem::create_directories(folder_); }
  ~MapFile() override { std::filesystem::remove_all(folder_); }

  static std::vector<MapPoint> some_map() {
    std::vector<MapPoint> map(500);
    for (std::size_t k = 0; k < map.size(); ++k) {
      const float x = 0.37f * static_cast<float>(k);
      map[k] = {{x, -1.0f / (1.0f + x), 1e-6f * x}, Eigen::Vector3f(std::sin(x), 0.0f, std::cos(x)), 0.001f * x};
    }
    map[7].normal_W.setZero();
    return map;
  }
  static std::string complaint(const std::filesystem::path& path) {
    try {
      read_pcd_map(path);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("tumble_map_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

void expect_equal(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].position_W_m, b[k].position_W_m) << k;
    ASSERT_EQ(a[k].normal_W, b[k].normal_W) << k;
    ASSERT_EQ(a[k].sigma_m, b[k].sigma_m) << k;
  }
}

TEST_F(MapFile, PlyAndPcdGiveBackEveryBit) {
  const std::vector<MapPoint> map = some_map();
  write_map(folder_ / "map.ply", map);
  expect_equal(read_map(folder_ / "map.ply"), map);
  write_pcd_map(folder_ / "map.pcd", map);
  expect_equal(read_pcd_map(folder_ / "map.pcd"), map);
}

TEST_F(MapFile, PcdThatIsNoMapIsRefusedInSilence) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  const std::filesystem::path path = folder_ / "map.pcd";
  EXPECT_NE(complaint(path).find("no such file"), std::string::npos);
  write_pcd_map(path, some_map());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 100);
  EXPECT_NE(complaint(path).find("truncated"), std::string::npos);
  std::ofstream(path) << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
                         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n";
  EXPECT_NE(complaint(path).find("no field 'normal_x'"), std::string::npos);
  EXPECT_THROW(write_pcd_map(folder_ / "absent" / "map.pcd", some_map()), BadInput);
  EXPECT_THROW(write_pcd_map(path, {}), BadInput);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace tumble::scenarios
