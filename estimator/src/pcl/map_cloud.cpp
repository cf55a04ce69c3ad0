// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/pcl/map_cloud.hpp"

namespace tumble {

pcl::PointCloud<pcl::PointXYZINormal> to_map_cloud(std::span<const MapPoint> points) {
  pcl::PointCloud<pcl::PointXYZINormal> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) {
    pcl::PointXYZINormal out;
    out.getVector3fMap() = point.position_W_m;
    out.getNormalVector3fMap() = point.normal_W;
    out.intensity = point.sigma_m;
    cloud.push_back(out);
  }
  return cloud;
}

std::vector<MapPoint> from_map_cloud(const pcl::PointCloud<pcl::PointXYZINormal>& cloud) {
  std::vector<MapPoint> points;
  points.reserve(cloud.size());
  for (const pcl::PointXYZINormal& in : cloud) {
    points.push_back({in.getVector3fMap(), in.getNormalVector3fMap(), in.intensity});
  }
  return points;
}

}  // namespace tumble
