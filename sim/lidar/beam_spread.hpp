// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

inline constexpr int kMaxBeamRays = 16;

struct Echoes {
  RayPacket packet;  ///< return of a single surface with the same energy as the beam
  alignas(64) float hit_x[kLanes], hit_y[kLanes], hit_z[kLanes];  ///< hit of the strongest ray, in world axes
};

class BeamSpread {
 public:
  explicit BeamSpread(const Values& values);

  int rays() const { return rays_; }  ///< number of rays per beam; 1: infinitely thin beam
  void bend(const ChannelFirings& axis, int k, ChannelFirings& firings) const;
  void merge(const std::array<RayPacket, kMaxBeamRays>& rays, Echoes& echoes) const;

 private:
  int rays_;
  float echo_length_m_;
  std::array<double, kMaxBeamRays> across_, up_;  ///< tangents of the angles between ray and beam axis
};

void set_hits(Echoes& echoes);

}  // namespace tumble::sim
