// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// Converts map points to a PCL cloud: positions, normals, and sigma_m in the field `intensity` (PCL has no field for
/// it). The curvature is 0. Users of this header find PCL themselves or get it from find_package(tumble). O(n).
pcl::PointCloud<pcl::PointXYZINormal> to_pcl(std::span<const MapPoint> points);

/// Converts a PCL cloud to map points, the inverse of to_pcl. O(n).
std::vector<MapPoint> from_pcl(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
