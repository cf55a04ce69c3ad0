// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// Paths for pictures and plots. Nothing here scores: scenarios/scoring does.
namespace tumble::tools {

/// A path in W of one point of the robot: the sphere's geometric centre, or the centre of mass of any other robot.
struct Path {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> points_W_m;
  bool empty() const { return points_W_m.empty(); }
};

/// The pose of A in W, its attitude made of unit length.
Eigen::Isometry3d pose_of(const PoseState& state);

/// Mounting of the frame that an estimate's poses belong to, as the estimator was given it; false where the recording
/// or its truth, if there is one, lacks the sensor. `truth` may be null: the sphere's centre is then the body's origin.
bool given_mounting(scenarios::Frame frame, const sim::Sensors& sensors, const sim::Truth* truth,
                    Eigen::Isometry3d& T_BA);

/// The true path, every `stride`-th physics sample and the last one.
Path true_path(const sim::Sensors& sensors, const sim::Truth& truth, std::size_t stride);

/// The path of an estimate, moved to where the truth is at the estimate's first pose: position and yaw alone, as the
/// scores align. Empty when the estimate has no poses, or lies in a frame of a sensor that the recording does not have.
Path estimated_path(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth& truth);

/// `path` up to where it first leaves the surroundings of `truth`: its bounding box, widened on every side by half of
/// its diagonal and 1 m at least. A picture that had to hold an estimate which has run away would show nothing else.
Path near_truth(const Path& path, const Path& truth);

/// First and last instant at which the body moves (faster than 0.1 m/s or 0.2 rad/s), widened by `margin_s` on either
/// side and kept within the truth; the whole of it when nothing moves.
struct Span {
  std::int64_t begin_ns = 0, end_ns = 0;
};
Span moving_span(const sim::Truth& truth, double margin_s);

}  // namespace tumble::tools
