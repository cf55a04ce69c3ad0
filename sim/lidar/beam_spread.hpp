// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/lidar/beam_pattern.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// kMaxBeamRays is the maximum number of rays per beam.
inline constexpr int kMaxBeamRays = 16;

/// Echoes contains for each firing (lane) the echo of a beam of finite width from which the device measures the range.
struct Echoes {
  RayPacket packet;  ///< range of the echo; reflectivity and cosine of a single surface with equal energy
  alignas(64) float hit_x[kLanes], hit_y[kLanes], hit_z[kLanes];  ///< hit of the ray with the most energy, world axes
};

/// BeamSpread models a beam of finite width as a fixed pattern of rays, which divide the beam's elliptical
/// cross-section into equal areas (Vogel, Mathematical Biosciences 44, 1979). Each ray returns an energy of
/// reflectivity times cosine of incidence, divided by the range squared. Hits whose ranges differ by less than the
/// length of the echo merge into one echo. The measured range is the energy-weighted mean of the ranges in the
/// strongest echo. At an edge, the range is therefore between the two surfaces, or the range of one surface if the
/// surfaces are farther apart. Surface id and exact hit are those of the ray with the most energy. The model excludes
/// an intensity profile over the beam, and several returns per firing.
class BeamSpread {
 public:
  explicit BeamSpread(const Values& values);

  int rays() const { return rays_; }  ///< number of rays per beam; 1: no beam width
  /// Returns the firings along ray `k` of the beams whose axes are `axis`.
  void bend(const ChannelFirings& axis, int k, ChannelFirings& firings) const;
  /// Merges the hits of all rays into one echo per lane.
  void merge(const std::array<RayPacket, kMaxBeamRays>& rays, Echoes& echoes) const;

 private:
  int rays_;
  float echo_length_m_;
  std::array<double, kMaxBeamRays> across_, up_;  ///< tangents of the angular offsets
};

/// Sets the exact hits of beams without width.
void set_hits(Echoes& echoes);

}  // namespace tumble::sim
