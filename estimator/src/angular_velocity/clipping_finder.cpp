// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/clipping_finder.hpp"

#include "element_clipping.hpp"
#include "tumble/angular_velocity/sample_hold.hpp"

namespace tumble {

RailPlanes KnownRails::planes_in_use() const {
  return upright ? without_plateaus(planes, walls) : planes;
}

ClippingFinder::ClippingFinder(const Params& params)
    : walls_(params.walls), planes_(stated_planes(params)), unstated_(unstated_planes(params)) {}

ClippingFinder::Found ClippingFinder::find(std::span<const ImuSample> samples) const {
  Found out;
  out.clippings.resize(samples.size());
  walls_.classify_all(samples, out.rails.walls, out.clippings);
  std::vector<Eigen::Vector3d> readings(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) readings[k] = samples[k].angular_velocity_rad_s;
  RailPlaneFinder::Workspace workspace;
  const bool stated = !stated_range_contradicted(walls_, out.rails.walls);
  out.rails.planes = (stated ? planes_ : unstated_).find(readings, {}, workspace);
  out.rails.upright = are_upright(readings, out.rails.planes, out.rails.walls);
  const RailPlanes planes = out.rails.planes_in_use();
  if (!planes.any()) return out;
  const std::vector<Neighbours> beside = other_readings(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out.clippings[k] = clip_by_planes(planes, out.clippings[k], beside[k].before, samples[k], beside[k].after);
  }
  return out;
}

}  // namespace tumble
