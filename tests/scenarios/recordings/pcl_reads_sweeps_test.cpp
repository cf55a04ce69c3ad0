// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cstring>

#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using PclReadsSweeps = fixture::Folder;

template <class Number>
Number value_of(const pcl::PCLPointCloud2& cloud, const std::string& field, std::size_t point) {
  for (const pcl::PCLPointField& each : cloud.fields) {
    if (each.name != field) continue;
    Number value;
    std::memcpy(&value, cloud.data.data() + point * cloud.point_step + each.offset, sizeof(value));
    return value;
  }
  ADD_FAILURE() << "no field " << field;
  return Number{};
}

/// Sweep 1 of the fixture contains points 50 to 99.
void expect_second_sweep(const pcl::PCLPointCloud2& cloud) {
  const sim::Sensors sensors = fixture::recording().sensors;
  const sim::LidarRecord& lidar = sensors.lidars[0];
  ASSERT_EQ(cloud.width * cloud.height, 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(value_of<float>(cloud, "x", i), lidar.position_L_m[50 + i].x());
    EXPECT_EQ(value_of<float>(cloud, "y", i), lidar.position_L_m[50 + i].y());
    EXPECT_EQ(value_of<float>(cloud, "z", i), lidar.position_L_m[50 + i].z());
    EXPECT_EQ(value_of<float>(cloud, "intensity", i), lidar.intensity[50 + i]);
    EXPECT_EQ(value_of<std::uint16_t>(cloud, "ring", i), lidar.ring[50 + i]);
    EXPECT_EQ(value_of<std::uint32_t>(cloud, "offset_ns", i), lidar.offset_ns[50 + i]);
  }
}

// PCL is an independent reader of both formats.
TEST_F(PclReadsSweeps, Pcd) {
  export_pcd(fixture::recording().sensors, folder_);
  EXPECT_EQ(files(), 4u) << "three sweeps and their stamps";
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder_ / "lidar_000001.pcd").string(), cloud), 0);
  expect_second_sweep(cloud);
}

TEST_F(PclReadsSweeps, Ply) {
  export_ply(fixture::recording().sensors, folder_ / "new");
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::io::loadPLYFile((folder_ / "new/lidar_000001.ply").string(), cloud), 0);
  expect_second_sweep(cloud);
}

}  // namespace
}  // namespace tumble::scenarios
