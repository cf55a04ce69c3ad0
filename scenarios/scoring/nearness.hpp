// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble::scenarios {

/// Answers whether any point of a set lies within a fixed distance: a hash of cells as wide as the distance, so that 27
/// cells are looked at. Exact. Points that are not finite are left out.
class Nearness {
 public:
  Nearness(std::span<const Eigen::Vector3f> points_m, float distance_m);
  bool has_neighbour(const Eigen::Vector3f& point_m) const;

 private:
  float distance_m_;
  std::vector<Eigen::Vector3f> points_m_;                        ///< sorted by cell
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges_;  ///< of points_m_, a cell each
  SpatialHash cells_;                                            ///< key -> place in ranges_
};

/// One point of each occupied cell of `cell_m`, the first given; order kept. Points that are not finite are left out.
std::vector<Eigen::Vector3f> one_per_cell(std::span<const Eigen::Vector3f> points_m, float cell_m);

}  // namespace tumble::scenarios
