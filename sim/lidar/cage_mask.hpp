// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/scene_geometry.hpp"

namespace tumble::sim {

/// Which firings of a repeating pattern can meet the robot's own cage, worked out once: the cage is rigid to the lidar,
/// and most firings miss it. Never says no to a firing that does meet it: each cell's middle is cast against shapes
/// widened by the way that a beam of the cell can be off the middle.
class CageMask {
 public:
  /// `cage` in the axes of L. Of a pattern that does not repeat every firing is said to meet it.
  CageMask(const SceneGeometry& cage, const BeamPattern& pattern);

  /// Whether any firing of a channel in the block may meet the cage.
  bool may_hit(const FiringBlock& block, int channel) const {
    if (cells_ == 0) return !is_empty_;
    bool may = false;
    for (const int cell : block.cell) may = may || meets_[static_cast<std::size_t>(channel * cells_ + cell)] != 0;
    return may;
  }

 private:
  bool is_empty_;
  int cells_;
  std::vector<std::uint8_t> meets_;  ///< by channel, then cell
};

}  // namespace tumble::sim
