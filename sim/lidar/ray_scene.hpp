// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "sim/lidar/scene_geometry.hpp"

namespace tumble::sim {

/// Number of rays that are cast together: successive rays of one laser, with similar directions.
inline constexpr int kLanes = 16;

struct RayPacket {
  int count = kLanes;
  alignas(64) float origin_x[kLanes], origin_y[kLanes], origin_z[kLanes];
  alignas(64) float direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< unit vectors
  /// As input, the maximum range of the ray. As output, the range of the hit; unchanged if the ray has no hit.
  alignas(64) float range[kLanes];
  alignas(64) float cosine[kLanes];  ///< of the angle of incidence
  alignas(64) float reflectivity[kLanes];
  alignas(64) std::int32_t surface_id[kLanes];  ///< input: kNothing, or the surface of an earlier hit
};

inline constexpr std::int32_t kNothing = -1;

/// RayScene casts rays against the world with Embree. Several threads may call const members at the same time.
/// Coordinates are floats, so a hit 50 m from the origin is accurate to about 1e-5 m. Hits are bit-identical on every
/// x86-64 CPU with AVX2 and FMA.
class RayScene {
 public:
  explicit RayScene(const SceneGeometry& geometry);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  bool empty() const;
  void cast(RayPacket& packet) const;
  float distance(const Eigen::Vector3f& point_m, float limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
