// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "sim/lidar/ray_scene.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

struct LaneNoise {
  alignas(64) float normal[kLanes];   ///< mean 0, deviation 1
  alignas(64) float uniform[kLanes];  ///< in (0, 1)
};

/// LaneNoiseSource draws random numbers for sixteen rays (lanes) at a time by Philox 4x32-10 and Box-Muller (1958), in
/// single precision. Each number depends only on the random stream, the packet number and the lane.
class LaneNoiseSource {
 public:
  explicit LaneNoiseSource(const Stream& stream);

  /// The number `index` of the ray packet must be below 2^61.
  void draw(std::uint64_t index, LaneNoise& noise) const;

 private:
  std::array<std::uint32_t, 2> key_;
};

}  // namespace tumble::sim
