// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "sim/situation.hpp"

namespace tumble::sim {

/// The true surface of a situation's world, for scoring maps: distance to the nearest surface of the static world.
class Surface {
 public:
  /// Rebuilds the world of a resolved situation. Throws InvalidSituation.
  Surface(const Situation& situation, const std::filesystem::path& models);
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
