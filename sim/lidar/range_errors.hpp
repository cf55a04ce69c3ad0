// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/lidar/lane_noise.hpp"
#include "sim/lidar/ray_scene.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// What a device makes of sixteen exact hits; numbers count where `kept` is set.
struct Returns {
  bool kept[kLanes];
  alignas(64) float range_m[kLanes];
  alignas(64) float intensity[kLanes];  ///< 0..1
};

/// Errors of ranging, in this order: loss of weak returns (by range, incidence, reflectivity) and at random, white
/// noise, limits of range, quantum. Intensity is reflectivity times the cosine of incidence, as a device that
/// compensates for range reports it, cut to its quantum. Not modelled: range bias by incidence or intensity,
/// cross-talk, several returns of one firing. Divergence and mixed returns: BeamSpread, before this.
class RangeErrors {
 public:
  RangeErrors(const Values& values, std::uint64_t seed, std::string_view stream_name);

  /// Pure: depends on the seed, the name, `index` (unique for a packet) and the hits alone.
  void apply(const RayPacket& hits, std::uint64_t index, Returns& returns) const;

 private:
  bool is_detected(float signal, double uniform) const;

  LaneNoiseSource noise_;
  double noise_m_, quantum_m_, min_m_, max_m_, detection2_m2_, reference_reflectivity_, steepness_, kept_share_,
      intensity_quantum_, sure_signal_, certain_signal_;
};

}  // namespace tumble::sim
