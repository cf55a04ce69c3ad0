// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/cage_mask.hpp"

#include <algorithm>
#include <cmath>

#include "sim/lidar/ray_aim.hpp"

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

Shape widened(Shape shape, double margin_m) {
  Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::plane:
      shape.kind = ShapeKind::box;
      size = Vector3d(size.x() + margin_m, size.y() + margin_m, margin_m);
      break;
    case ShapeKind::ellipsoid:
      // The enlarged ellipsoid has a distance of at least `margin_m` from the original ellipsoid.
      size *= 1.0 + margin_m / size.minCoeff();
      break;
    case ShapeKind::capsule:
      size.x() += margin_m;
      break;
    case ShapeKind::sphere:
    case ShapeKind::cylinder:
    case ShapeKind::box:
      size += Vector3d::Constant(margin_m);
      break;
  }
  return shape;
}

Shape box_around(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& v : mesh.vertices_F_m) bounds.extend(v);
  Shape box;
  box.kind = ShapeKind::box;
  box.p_FS_m = bounds.center().cast<double>();
  box.size_m = 0.5 * bounds.sizes().cast<double>();
  return box;
}

}  // namespace

CageMask::CageMask(const SceneGeometry& cage, const BeamPattern& pattern)
    : is_empty_(cage.shapes.empty() && cage.meshes.empty()), cells_(pattern.cells()) {
  if (cells_ == 0) return;
  meets_.assign(static_cast<std::size_t>(pattern.channels() * cells_), 0);
  if (is_empty_) return;

  SceneGeometry wide;
  for (const SceneShape& part : cage.shapes) wide.shapes.push_back(part);
  for (const SceneMesh& part : cage.meshes) {
    wide.shapes.push_back({box_around(part.mesh), part.surface_id, part.reflectivity});
  }
  double reach_m = 0.0;
  for (const SceneShape& part : wide.shapes) {
    reach_m = std::max(reach_m, part.shape.p_FS_m.norm() + half_extent(part.shape).norm());
  }
  if (!std::isfinite(reach_m)) {  // an infinite plane gives no bound
    std::fill(meets_.begin(), meets_.end(), std::uint8_t{1});
    return;
  }
  // The margin allows for the width of an azimuth cell: a beam of the cell differs from the middle beam by a rotation
  // about z of at most half a cell.
  const double margin_m = reach_m * pattern.cell_half_angle_rad() + 1e-4 * (1.0 + reach_m);
  for (SceneShape& part : wide.shapes) part.shape = widened(part.shape, margin_m);

  const RayScene scene(wide);
  FiringBlock block;
  RayPacket rays;
  for (int first = 0; first < cells_; first += kLanes) {
    pattern.fire_cells(first, block);
    for (int c = 0; c < pattern.channels(); ++c) {
      aim_in_lidar_axes(block.channel[c], rays);
      for (int i = 0; i < kLanes; ++i) {
        rays.range[i] = static_cast<float>(4.0 * reach_m + 1.0);
        rays.surface_id[i] = kNothing;
      }
      scene.cast(rays);
      for (int i = 0; i < kLanes; ++i) {
        meets_[static_cast<std::size_t>(c * cells_ + first + i)] = rays.surface_id[i] != kNothing;
      }
    }
  }
}

}  // namespace tumble::sim
