// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <vector>

#include "tumble/mapping/types.hpp"

namespace tumble {

/// Converts a map to a point cloud of PCL. The field `intensity` contains the standard deviation of the point's
/// position [m], and `curvature` is 0. Programs that include map_cloud.hpp must find PCL, directly or through
/// find_package(tumble). Cost: O(n).
pcl::PointCloud<pcl::PointXYZINormal> to_map_cloud(std::span<const MapPoint> points);

/// Converts a point cloud that to_map_cloud() returned to map points. Cost: O(n).
std::vector<MapPoint> from_map_cloud(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
