// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <vector>

#include "tumble/mapping/types.hpp"

namespace tumble {

/// The field `intensity` of the cloud contains the standard deviation sigma_m, and `curvature` is 0. Programs that
/// include map_cloud.hpp must find PCL, directly or through find_package(tumble). Cost: O(n).
pcl::PointCloud<pcl::PointXYZINormal> to_pcl(std::span<const MapPoint> points);

/// Inverse of to_pcl(). Cost: O(n).
std::vector<MapPoint> from_pcl(const pcl::PointCloud<pcl::PointXYZINormal>& cloud);

}  // namespace tumble
