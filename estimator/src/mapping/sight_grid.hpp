// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tumble::mapping {

/// How far a sweep saw in each direction: the nearest return per bin of a cube of directions about one place, axes of
/// the world. What stands nearer than all returns about its direction is not there now, mapping.md (R122): free space.
/// A direction about which little returned says nothing, nor does one at an edge of the cube.
class SightGrid {
 public:
  /// Looks from here on from a place out of which a sweep saw whose sensor moved by so much on each side of it.
  void start(const Eigen::Vector3f& from_W_m, float moved_m);
  void add(const Eigen::Vector3f& return_W_m);

  enum class Verdict { unknown, seen, seen_through };
  /// What the sweep says of a point of the map whose place is known so well. O(1).
  Verdict verdict(const Eigen::Vector3f& point_W_m, float sigma_m) const;

 private:
  static constexpr int kBins = 60;  // along an edge: 1 to 2 deg
  struct Direction {
    int face, u, v;
    std::size_t bin() const { return static_cast<std::size_t>((face * kBins + v) * kBins + u); }
  };
  static std::optional<Direction> direction(const Eigen::Vector3f& lever_m);
  float free_m(const Direction& towards) const;

  Eigen::Vector3f from_W_m_ = Eigen::Vector3f::Zero();
  float least_m_ = 0.0f;
  std::vector<float> nearest_m_;  // infinity where nothing returned
};

}  // namespace tumble::mapping
