// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble::scenarios {

class Nearness {
 public:
  Nearness(std::span<const Eigen::Vector3f> points_m, float distance_m);
  bool has_neighbour(const Eigen::Vector3f& point_m) const;

 private:
  float distance_m_;
  std::vector<Eigen::Vector3f> points_m_;                        ///< sorted by cell
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges_;  ///< ranges of points_m_, one per cell
  SpatialHash cells_;                                            ///< key -> index in ranges_
};

std::vector<Eigen::Vector3f> one_per_cell(std::span<const Eigen::Vector3f> points_m, float cell_m);

}  // namespace tumble::scenarios
