// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

/// Surface is the true surface of a situation's static world. The error of a map is the distance of its points from
/// Surface.
class Surface {
 public:
  /// Constructs from the static geoms of a compiled world. Throws InvalidSituation for a geom without a surface.
  explicit Surface(const BuiltSituation& built);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  /// Returns the distance of each point to the nearest surface [m], at most `limit_m`.
  std::vector<float> distances(std::span<const Eigen::Vector3f> points_W_m, float limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
