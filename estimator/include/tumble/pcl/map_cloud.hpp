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
pcl::PointCloud<pcl::PointXYZINormal> to_pcl(std::span<const MapPoint> points);

/// Converts a point cloud of to_pcl() to map points. Cost: O(n).
std::vector<MapPoint> from_pcl(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
