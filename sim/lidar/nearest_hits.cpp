// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/nearest_hits.hpp"

#include <cmath>

namespace tumble::sim {

[[gnu::target("avx2")]] NearestHits::NearestHits(const RayPacket& packet) {
  for (int i = 0; i < kLanes; ++i) {
    range_m_[i] = packet.range[i];
    normal_x_[i] = normal_y_[i] = normal_z_[i] = 0.0;
  }
  geometry_.fill(kNone);
  primitive_.fill(0);
}

[[gnu::target("avx2")]] void NearestHits::write(RayPacket& packet) const {
  for (int i = 0; i < kLanes; ++i) {
    const double x = normal_x_[i], y = normal_y_[i], z = normal_z_[i];
    // The terms of the dot product are added in the same order as in Eigen, so that both results are bit-identical.
    const double along = x * packet.direction_x[i] + y * packet.direction_y[i] + z * packet.direction_z[i];
    const double cosine = std::abs(along) / std::sqrt(x * x + y * y + z * z);
    const bool hit = geometry_[static_cast<std::size_t>(i)] != kNone;
    packet.range[i] = hit ? static_cast<float>(range_m_[i]) : packet.range[i];
    packet.cosine[i] = hit ? static_cast<float>(cosine < 1.0 ? cosine : 1.0) : packet.cosine[i];
  }
}

}  // namespace tumble::sim
