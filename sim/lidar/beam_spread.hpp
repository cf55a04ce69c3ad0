// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

inline constexpr int kMaxBeamRays = 16;

struct Echoes {
  RayPacket packet;                                               ///< single surface with equal energy
  alignas(64) float hit_x[kLanes], hit_y[kLanes], hit_z[kLanes];  ///< strongest ray, world axes
};

class BeamSpread {
 public:
  explicit BeamSpread(const Values& values);

  int rays() const { return rays_; }  ///< 1: no beam width
  void bend(const ChannelFirings& axis, int k, ChannelFirings& firings) const;
  void merge(const std::array<RayPacket, kMaxBeamRays>& rays, Echoes& echoes) const;

 private:
  int rays_;
  float echo_length_m_;
  std::array<double, kMaxBeamRays> across_, up_;  ///< tangents of the angular offsets
};

void set_hits(Echoes& echoes);

}  // namespace tumble::sim
