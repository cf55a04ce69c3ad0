// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

class Surface {
 public:
  explicit Surface(const BuiltSituation& built);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  std::vector<float> distances(std::span<const Eigen::Vector3f> points_W_m, float limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
