// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

/// The true surface of a situation's world, for scoring maps: distance to the nearest surface of the static world.
class Surface {
 public:
  /// Takes the world's static geoms over into a scene for rays; nothing is composed again. Throws InvalidSituation on a
  /// geom that has no surface.
  explicit Surface(const BuiltSituation& built);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  /// Distance of each point to the nearest surface [m], at most `limit_m` (what lies farther gives `limit_m`).
  std::vector<float> distances(std::span<const Eigen::Vector3f> points_W_m, float limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
