// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/lidar/ray_scene.hpp"

namespace tumble::sim {

/// NearestHits contains the nearest hit of each ray. Among hits at equal ranges, the hit with the lowest geometry
/// number is used, so that the order of calls is irrelevant.
class NearestHits {
 public:
  static constexpr unsigned int kNone = ~0u;

  explicit NearestHits(const RayPacket& packet);

  bool is_replaced(unsigned int lane, double by_range_m, unsigned int by_geometry, unsigned int by_primitive) const {
    if (!(by_range_m > 0.0) || by_range_m > range_m_[lane]) return false;
    return by_range_m < range_m_[lane] ||
           (geometry_[lane] != kNone &&
            (by_geometry < geometry_[lane] || (by_geometry == geometry_[lane] && by_primitive < primitive_[lane])));
  }
  void replace(unsigned int lane, double range_m, double normal_x, double normal_y, double normal_z,
               unsigned int geometry, unsigned int primitive) {
    range_m_[lane] = range_m;
    normal_x_[lane] = normal_x;
    normal_y_[lane] = normal_y;
    normal_z_[lane] = normal_z;
    geometry_[lane] = geometry;
    primitive_[lane] = primitive;
  }

  unsigned int geometry(int lane) const { return geometry_[static_cast<std::size_t>(lane)]; }  ///< kNone: no hit
  unsigned int primitive(int lane) const { return primitive_[static_cast<std::size_t>(lane)]; }
  void write(RayPacket& packet) const;

 private:
  alignas(64) double range_m_[kLanes];
  alignas(64) double normal_x_[kLanes], normal_y_[kLanes], normal_z_[kLanes];
  std::array<unsigned int, kLanes> geometry_, primitive_;
};

}  // namespace tumble::sim
