// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cstdio>
#include <tumble/pcl/map_cloud.hpp>

using Cloud = pcl::PointCloud<pcl::PointXYZINormal>;

// writes a map to PCD and PLY by PCL's own writers, and reads it with normals and uncertainty
int main() {
  std::vector<tumble::MapPoint> map(3);
  for (std::size_t k = 0; k < map.size(); ++k) {
    map[k].position_W_m = Eigen::Vector3f(1.0F, 2.0F, static_cast<float>(k));
    map[k].normal_W = Eigen::Vector3f::UnitZ();
    map[k].sigma_m = 0.25F;
  }
  const Cloud cloud = tumble::to_map_cloud(map);
  if (pcl::io::savePCDFileBinary("map.pcd", cloud) != 0 || pcl::io::savePLYFileBinary("map.ply", cloud) != 0) return 1;
  Cloud pcd, ply;
  if (pcl::io::loadPCDFile("map.pcd", pcd) != 0 || pcl::io::loadPLYFile("map.ply", ply) != 0) return 2;
  for (const Cloud* read : {&pcd, &ply}) {
    const std::vector<tumble::MapPoint> back = tumble::from_map_cloud(*read);
    if (back.size() != map.size() || back[2].position_W_m != map[2].position_W_m ||
        back[2].normal_W != map[2].normal_W || back[2].sigma_m != map[2].sigma_m)
      return 3;
  }
  std::printf("%zu points\n", cloud.size());
}
