// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/lidar/lane_noise.hpp"
#include "sim/lidar/ray_scene.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

struct Returns {
  bool kept[kLanes];
  alignas(64) float range_m[kLanes];
  alignas(64) float intensity[kLanes];  ///< 0 to 1
};

/// RangeErrors simulates the range errors of a lidar in this order: loss of weak returns (by range, angle of incidence
/// and reflectivity), random loss, white noise, range limits, quantisation. The simulated intensity is the reflectivity
/// times the cosine of the angle of incidence, as in devices that compensate for range. The simulation does not include
/// range bias by angle of incidence or intensity, cross-talk, or several returns per laser pulse.
class RangeErrors {
 public:
  RangeErrors(const Values& values, std::uint64_t seed, std::string_view stream_name);

  void apply(const RayPacket& hits, std::uint64_t index, Returns& returns) const;

 private:
  bool is_detected(float signal, double uniform) const;

  LaneNoiseSource noise_;
  double noise_m_, quantum_m_, min_m_, max_m_, detection2_m2_, reference_reflectivity_, steepness_, kept_share_,
      intensity_quantum_, sure_signal_, certain_signal_;
};

}  // namespace tumble::sim
