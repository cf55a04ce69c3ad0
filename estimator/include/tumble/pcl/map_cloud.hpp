// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// Converts map points to a PCL cloud of positions and normals. The field `intensity` contains sigma_m, because PCL has
/// no field for a standard deviation. The curvature is 0. Users of this header find PCL themselves or get PCL from
/// find_package(tumble). Cost: O(n).
pcl::PointCloud<pcl::PointXYZINormal> to_pcl(std::span<const MapPoint> points);

/// Converts a PCL cloud to map points, the inverse of to_pcl. O(n).
std::vector<MapPoint> from_pcl(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
