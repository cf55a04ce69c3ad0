// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Most rays of a beam.
inline constexpr int kMaxBeamRays = 16;

/// What a beam of some width meets, one lane a firing: the echo that a device ranges on.
struct Echoes {
  RayPacket packet;  ///< range of the echo; reflectivity and cosine as a single surface of that echo would have them
  alignas(64) float hit_x[kLanes], hit_y[kLanes], hit_z[kLanes];  ///< of the ray that returned the most, world axes
};

/// The width of a beam, sampled by a fixed pattern of rays (H. Vogel, Math. Biosci. 44, 1979: equal shares of the
/// ellipse's area). Each ray returns energy as reflectivity times cosine over range squared. Hits nearer to each other
/// in range than the echo's length merge; of several echoes the strongest counts, at the mean of its ranges weighted by
/// energy: a beam across an edge gives a mixed return between the two surfaces, or a jump from one to the other where
/// they lie farther apart. Surface id and exact hit are those of the ray that returned the most of it.
/// Not modelled: a profile of intensity over the beam, several returns of a firing.
class BeamSpread {
 public:
  explicit BeamSpread(const Values& values);

  int rays() const { return rays_; }  ///< 1: off
  /// Firings along ray `k` of the beams; the axis is the given direction.
  void bend(const ChannelFirings& axis, int k, ChannelFirings& firings) const;
  /// One echo a lane out of the hits of all rays.
  void merge(const std::array<RayPacket, kMaxBeamRays>& rays, Echoes& echoes) const;

 private:
  int rays_;
  float echo_length_m_;
  std::array<double, kMaxBeamRays> across_, up_;  ///< tangents of the offsets
};

/// The exact hits of rays without width.
void set_hits(Echoes& echoes);

}  // namespace tumble::sim
