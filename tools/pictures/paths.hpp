// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"

namespace tumble::tools {

struct Path {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> points_W_m;
  std::string name{};  ///< in the legend of a picture
  bool empty() const { return points_W_m.empty(); }
};

Eigen::Isometry3d pose_of(const PoseState& state);

bool given_mounting(scenarios::Frame frame, const sim::Sensors& sensors, const sim::Truth* truth,
                    Eigen::Isometry3d& T_BA);

Path true_path(const sim::Sensors& sensors, const sim::Truth& truth, std::size_t stride);

/// Returns the path of an estimate, aligned with the truth by position and yaw at its first pose, like the scores. The
/// path is empty if the estimate has no poses, or if the recording lacks the sensor of their frame.
Path estimated_path(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth& truth);

/// Returns `path` up to the first point outside the surroundings of `truth`, because a diverged estimate would fill the
/// whole picture.
Path near_truth(const Path& path, const Path& truth);

struct Span {
  std::int64_t begin_ns = 0, end_ns = 0;
};
Span moving_span(const sim::Truth& truth, double margin_s);

}  // namespace tumble::tools
