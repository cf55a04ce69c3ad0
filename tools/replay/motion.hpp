// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// How the body moved, by the truth or by an estimate, in one world for all.
namespace tumble::tools {

/// Poses of the body B in W at rising instants. Between two the position is interpolated linearly and the attitude by
/// slerp; outside, and in gaps of more than half a second or four usual steps, nothing is known.
class Motion {
 public:
  Motion() = default;
  /// Leaves out what is not finite, not after the one before, or farther than 10 km from the first.
  Motion(const std::vector<std::int64_t>& time_ns, const std::vector<Eigen::Isometry3d>& T_WB);

  bool empty() const { return time_ns_.empty(); }
  std::int64_t begin_ns() const { return time_ns_.front(); }
  std::int64_t end_ns() const { return time_ns_.back(); }
  /// O(log N).
  std::optional<Eigen::Isometry3d> at(std::int64_t time_ns) const;

 private:
  std::vector<std::int64_t> time_ns_;
  std::vector<Eigen::Vector3d> p_WB_m_;
  std::vector<Eigen::Quaterniond> q_WB_;
  std::int64_t gap_ns_ = 0;
};

/// Of the truth, at instants `step_ns` apart; empty where it knows no position. Throws BadInput when it contradicts
/// itself.
Motion true_motion(const sim::Truth& truth, std::int64_t step_ns);

/// Of an estimate, from the frame of its poses to the body by the mounting that the estimator was given. With a truth
/// moved to it as the scores do (position and heading at the first pose that it covers); without, to `reference` in the
/// same way where that knows the instant, and left where it is otherwise. Empty without poses, or where their frame is
/// of a sensor that the recording does not have. `truth` may be null.
Motion estimated_motion(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth* truth,
                        const Motion& reference);

}  // namespace tumble::tools
