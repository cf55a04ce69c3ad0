// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tumble::mapping {

/// FreeSpaceGrid stores the range of the nearest return of a sweep in each direction. The directions are divided into
/// bins on the faces of a cube around the sensor. The beams of a sweep passed through a map point if all returns in
/// nearly the same direction are farther away: mapping.md (R65).
class FreeSpaceGrid {
 public:
  /// `from_W_m` is the assumed origin of all beams of a sweep. `moved_m` is the largest distance of the sensor from
  /// `from_W_m` during the sweep.
  void start(const Eigen::Vector3f& from_W_m, float moved_m);
  void add(const Eigen::Vector3f& return_W_m);

  enum class Verdict { unknown_space, occupied, free_space };
  /// Checks whether beams of the sweep hit a map point, or passed through its position. Cost: O(1).
  Verdict verdict(const Eigen::Vector3f& point_W_m, float sigma_m) const;

 private:
  static constexpr int kBins = 60;  // number of bins along an edge: 1 to 2 deg per bin
  struct Direction {
    int cube_face, column, row;
    std::size_t direction_bin_index() const {
      return static_cast<std::size_t>((cube_face * kBins + row) * kBins + column);
    }
  };
  static std::optional<Direction> direction(const Eigen::Vector3f& lever_m);
  float free_space_range_m(const Direction& towards) const;

  Eigen::Vector3f origin_W_m_ = Eigen::Vector3f::Zero();
  float range_min_m_ = 0.0f;
  std::vector<float> nearest_return_m_;  // infinity for a direction without a return
};

}  // namespace tumble::mapping
