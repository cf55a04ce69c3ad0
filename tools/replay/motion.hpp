// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"

namespace tumble::tools {

/// Motion contains poses of the body B in the world, with positions interpolated linearly and attitudes by slerp. The
/// pose is undefined outside the samples, and in gaps longer than half a second or four usual steps.
class Motion {
 public:
  Motion() = default;
  Motion(const std::vector<std::int64_t>& time_ns, const std::vector<Eigen::Isometry3d>& T_WB);

  bool empty() const { return time_ns_.empty(); }
  std::int64_t begin_ns() const { return time_ns_.front(); }
  std::int64_t end_ns() const { return time_ns_.back(); }
  std::optional<Eigen::Isometry3d> at(std::int64_t time_ns) const;

 private:
  std::vector<std::int64_t> time_ns_;
  std::vector<Eigen::Vector3d> p_WB_m_;
  std::vector<Eigen::Quaterniond> q_WB_;
  std::int64_t gap_ns_ = 0;
};

Motion true_motion(const sim::Truth& truth, std::int64_t step_ns);

/// The motion is aligned with the truth like the scores, or without a truth (null) with `reference`.
Motion estimated_motion(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth* truth,
                        const Motion& reference);

}  // namespace tumble::tools
