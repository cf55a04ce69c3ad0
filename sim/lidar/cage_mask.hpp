// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/scene_geometry.hpp"

namespace tumble::sim {

/// CageMask marks every laser pulse that may hit the robot's own cage. For all other pulses, the ray caster does not
/// test the cage.
class CageMask {
 public:
  CageMask(const SceneGeometry& cage, const BeamPattern& pattern);

  bool may_hit(const FiringBlock& block, int channel) const {
    if (cells_ == 0) return !is_empty_;
    bool may = false;
    for (const int cell : block.cell) may = may || meets_[static_cast<std::size_t>(channel * cells_ + cell)] != 0;
    return may;
  }

 private:
  bool is_empty_;
  int cells_;
  std::vector<std::uint8_t> meets_;  ///< bit per channel and cell
};

}  // namespace tumble::sim
