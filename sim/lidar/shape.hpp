// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tumble::sim {

enum class ShapeKind : std::uint8_t { plane, sphere, capsule, ellipsoid, cylinder, box };

/// Shape is a geometric primitive in its own frame. The size of a plane (normal z) contains the half sizes in x and y;
/// 0 means infinite. The size of a capsule or cylinder contains the radius and the half length along z.
struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_FS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_FS_m = Eigen::Vector3d::Zero();
};

/// Returns the range at which a ray hits the shape. A ray hits a plane only from its front, as in mj_ray.
double cast_ray(const Shape& shape, const Eigen::Vector3d& origin_F_m, const Eigen::Vector3d& direction_F,
                Eigen::Vector3d& normal_F);

/// Returns the distance of a point, inside or outside a shape, from the surface of the shape [m], with a relative error
/// of at most 1e-9.
double surface_distance(const Shape& shape, const Eigen::Vector3d& point_F_m);

bool contains(const Shape& shape, const Eigen::Vector3d& point_F_m);

Eigen::Vector3d half_extent(const Shape& shape);

}  // namespace tumble::sim
