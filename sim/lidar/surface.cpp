// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/surface.hpp"

#include "sim/lidar/ray_scene.hpp"

namespace tumble::sim {

struct Surface::Impl {
  RayScene scene;
};

Surface::Surface(const BuiltSituation& built)
    : impl_(new Impl{RayScene(static_geometry(built.world(), HeightFieldSides::open))}) {}

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

std::vector<float> Surface::distances(std::span<const Eigen::Vector3f> points_W_m, float limit_m) const {
  std::vector<float> out;
  out.reserve(points_W_m.size());
  for (const Eigen::Vector3f& point : points_W_m) out.push_back(impl_->scene.distance(point, limit_m));
  return out;
}

}  // namespace tumble::sim
