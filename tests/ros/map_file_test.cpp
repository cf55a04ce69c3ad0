// SPDX-License-Identifier: BSD-3-Clause
#include "tests/testing.hpp"

#include "tumble_ros/map_file.hpp"

#include <string>
#include <vector>

#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::ros {
namespace {

Status read(const std::string& file, std::vector<MapPoint>& points) {
  return read_map(std::as_bytes(std::span(file)), points);
}

std::vector<MapPoint> read(const std::string& file) {
  std::vector<MapPoint> points;
  EXPECT_EQ(read(file, points).message(), Status().message()) << file.substr(0, 200);
  return points;
}

template <class Number>
std::string bytes_of(std::initializer_list<Number> numbers) {
  return {reinterpret_cast<const char*>(numbers.begin()), numbers.size() * sizeof(Number)};
}

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types, int points,
                const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " +
         types + "\nWIDTH " + std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data;
}

const std::vector<MapPoint> kMap = {{{1.0F, 2.0F, 3.0F}, {0.0F, 0.0F, 1.0F}, 0.01F},
                                    {{4.0F, 5.0F, 6.0F}, {0.0F, 1.0F, 0.0F}, 0.03F}};

void expect_map(const std::vector<MapPoint>& points, float second_sigma_m = 0.03F) {
  ASSERT_EQ(points.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(points[k].position_W_m, kMap[k].position_W_m);
    EXPECT_EQ(points[k].normal_W, kMap[k].normal_W);
  }
  EXPECT_EQ(points[1].sigma_m, second_sigma_m);
}

TEST(MapFile, MapsOfSaveMapAndOfTheNodeAreReadBack) {
  const std::vector<std::byte> saved = save_map(kMap);
  expect_map(read({reinterpret_cast<const char*>(saved.data()), saved.size()}));
  expect_map(read(ply_of(kMap)));
}

TEST(MapFile, AnAsciiPlyMayHaveOtherFieldsAndElements) {
  expect_map(
      read("ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 2\r\nproperty double nx\r\nproperty "
           "float ny\r\nproperty float nz\r\nproperty uchar red\r\nproperty float x\r\nproperty float y\r\n"
           "property float z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
           "0 0 1 255 1 2 3\r\n0 1 0 0 4 5 6\r\n3 0 1 1\r\n"),
      0.02F);
}

TEST(MapFile, APcdIsReadInBothEncodings) {
  const std::string fields = "x y z normal_x normal_y normal_z sigma", sizes = "4 4 4 4 4 4 4", types = "F F F F F F F";
  expect_map(read(pcd(fields, sizes, types, 2, "ascii\n1 2 3 0 0 1 0.01\n4 5 6 0 1 0 0.03\n")));
  expect_map(read(pcd(fields, sizes, types, 2, "binary\n") +
                  bytes_of<float>({1, 2, 3, 0, 0, 1, 0.01F, 4, 5, 6, 0, 1, 0, 0.03F})));
  const std::string mixed = bytes_of<std::uint16_t>({7}) + bytes_of<double>({1, 2, 3});
  const std::vector<MapPoint> one = read(pcd("ring x y z", "2 8 8 8", "U F F F", 1, "binary\n") + mixed);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].position_W_m, kMap[0].position_W_m);
}

TEST(MapFile, NormalsAreFittedIfTheFileHasNone) {
  std::string rows;
  for (int k = 0; k < 100; ++k)
    rows += std::to_string(0.1 * (k % 10)) + " " + std::to_string(0.1 * (k / 10)) + " 0.5\n";
  const std::vector<MapPoint> plane = read(pcd("x y z", "4 4 4", "F F F", 101, "ascii\n") + rows + "nan nan nan\n");
  ASSERT_EQ(plane.size(), 100U) << "a point that is not finite is left out";
  for (const MapPoint& point : plane) EXPECT_NEAR(std::abs(point.normal_W.z()), 1.0F, 1e-4F);
}

TEST(MapFile, EachTruncatedFileIsRefusedAndTheMapStays) {
  const std::string xyz = pcd("x y z", "4 4 4", "F F F", 2, "");
  for (const std::string& whole :
       {ply_of(kMap), xyz + "binary\n" + bytes_of<float>({1, 2, 3, 4, 5, 6}), xyz + "ascii\n1 2 3\n4 5 6"}) {
    for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {
      std::vector<MapPoint> points = kMap;
      EXPECT_FALSE(read(whole.substr(0, bytes), points).ok()) << bytes;
      EXPECT_EQ(points.size(), kMap.size());
    }
  }
}

TEST(MapFile, TheErrorNamesTheWrongPartOfTheHeader) {
  const auto error = [](const std::string& file) {
    std::vector<MapPoint> points;
    return read(file, points).message();
  };
  const std::string ply = "ply\nformat ascii 1.0\n", end = "end_header\n0 0 0\n";
  EXPECT_THAT(error("ply\nformat binary_big_endian 1.0\n" + end), HasSubstr("known formats in the PLY header"));
  EXPECT_THAT(error(ply + "element face 1\n" + end), HasSubstr("at the start of the PLY file"));
  EXPECT_THAT(error(ply + "element vertex -1\n" + end), HasSubstr("at the start of the PLY file"));
  EXPECT_THAT(error(ply + "element vertex 1\nproperty list uchar int x\n" + end), HasSubstr("vertex property"));
  EXPECT_THAT(error(ply + "element vertex 1\nproperty float x\n" + end), HasSubstr("fields x, y and z"));
  EXPECT_THAT(error(ply + end), HasSubstr("vertex elements in the PLY header"));
  EXPECT_THAT(error(pcd("x y z", "4 4 4", "F F F", 1, "binary_compressed\n")), HasSubstr("DATA"));
  EXPECT_THAT(error(pcd("x y z", "4 4", "F F F", 1, "ascii\n")), HasSubstr("SIZE"));
  EXPECT_THAT(error(pcd("x y z", "3 4 4", "F F F", 1, "ascii\n")), HasSubstr("SIZE"));
  EXPECT_THAT(error(pcd("x y z", "4 4 4", "F F F", -1, "ascii\n")), HasSubstr("POINTS"));
  EXPECT_THAT(error(pcd("x y z", "4 4 4", "F F F", 2'000'000'000, "binary\n")), HasSubstr("points"));
}

}  // namespace
}  // namespace tumble::ros
