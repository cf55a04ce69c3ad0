// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// Converts map points to a PCL cloud of positions and normals. Cost: O(n). The field `intensity` of the cloud contains
/// sigma_m, because PCL has no field for a standard deviation; `curvature` is 0. Programs that include map_cloud.hpp
/// must find PCL, directly or through find_package(tumble).
pcl::PointCloud<pcl::PointXYZINormal> to_pcl(std::span<const MapPoint> points);

/// Inverse of to_pcl(). Cost: O(n).
std::vector<MapPoint> from_pcl(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
