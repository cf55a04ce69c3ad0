// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Lidar returns outside of the stated range are dropped.
struct LidarSheet {
  double range_min_m = 0.3;
  double range_max_m = 100.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.range_min_m,
          {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped", FieldRank::basic});
    visit(p.range_max_m,
          {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped", FieldRank::basic});
  }
};

/// Data sheets of the simulated sensors. The file models/sensors/NAME.yaml states the source of each number.
namespace sheets {

/// RoboSense RS-16.
LidarSheet rs16();
/// Livox Mid-40.
LidarSheet mid40();
/// Livox Mid-100.
LidarSheet mid100();
/// Velodyne VLP-16.
LidarSheet vlp16();
/// Hesai XT16.
LidarSheet xt16();
/// Hesai XT32.
LidarSheet xt32();
/// RoboSense Helios with 32 beams.
LidarSheet helios32();
/// Ouster OS0 with 64 rings.
LidarSheet os0_64();
/// Ouster OS0 with 128 rings.
LidarSheet os0_128();
/// Ouster OS1 with 64 rings.
LidarSheet os1_64();
/// Ouster OS1 with 128 rings.
LidarSheet os1_128();
/// Livox Mid-360.
LidarSheet mid360();

/// For programs that select a data sheet by name.
std::span<const std::pair<const char*, LidarSheet (*)()>> lidars();

}  // namespace sheets

}  // namespace tumble
