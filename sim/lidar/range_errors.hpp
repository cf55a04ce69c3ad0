// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "sim/lidar/ray_scene.hpp"
#include "sim/random/stream.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// What a device makes of sixteen exact hits.
struct Returns {
  std::array<bool, kLanes> kept;
  std::array<float, kLanes> range_m;
  std::array<float, kLanes> intensity;  ///< 0..1
};

/// Errors of ranging, in this order: loss of weak returns (by range, incidence, reflectivity) and at random, white
/// noise, limits of range, quantum. Intensity is reflectivity times the cosine of incidence, as a device that
/// compensates for range reports it, cut to its quantum. Not modelled: divergence of the beam and mixed returns at
/// edges, range bias by incidence or intensity, cross-talk, several returns of one firing.
class RangeErrors {
 public:
  RangeErrors(const Values& values, std::uint64_t seed, std::string_view stream_name);

  /// Pure: depends on the seed, the name, `slot` and the hits alone.
  Returns apply(const RayPacket& hits, std::int64_t slot) const;

 private:
  bool is_detected(const RayPacket& hits, int lane, double uniform) const;

  Stream stream_;
  double noise_m_, quantum_m_, min_m_, max_m_, detection2_m2_, reference_reflectivity_, steepness_, kept_share_,
      intensity_quantum_, sure_signal_;
};

}  // namespace tumble::sim
