// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

/// The functions in points.hpp provide the lidar points that a replay shows, with their distance to the true surface
/// for a given motion.
namespace tumble::tools {

/// Selects at most `most` returns of the first lidar, spread evenly over its sweeps and beams. Return i is selected if
/// the fractional part of i times the golden ratio is below the wanted fraction. The additive recurrence of the golden
/// ratio includes every beam, whereas "every tenth return" would always select the same beams of a 16-beam lidar.
/// Points on the robot's body are omitted: points that the truth marks, or points nearer than 0.5 m without a truth.
/// Without a lidar, the result is empty. The pointer `truth` may be null.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// Returns the transform from body axes of the estimator's calibration to body axes of the true mounting. The transform
/// is the identity if the truth has no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

/// Returns the distance of each point to the true surface [m], at most kMapErrorMax_m. The distance is NaN at instants
/// without a pose.
std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

}  // namespace tumble::tools
