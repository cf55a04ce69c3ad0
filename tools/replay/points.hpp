// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

/// points.hpp provides the lidar returns that a replay shows, with their distance to the true surface for a given
/// motion.
namespace tumble::tools {

/// Selects at most `most` returns of the first lidar, spread evenly over its sweeps and beams. Return i is selected if
/// the fractional part of i times the golden ratio is below the wanted fraction. The additive recurrence of the golden
/// ratio includes every beam, whereas "every tenth return" would always select the same beams of a 16-beam lidar.
/// Returns from the robot's own body are left out: returns that the truth marks, or returns nearer than 0.5 m if there
/// is no truth. shown_points returns no points without a lidar. `truth` may be null.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// Returns the transform from body axes by the estimator's calibration to body axes by the true mounting. The transform
/// is the identity if the truth has no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

/// Returns the distance of each point to the true surface [m], at most kMapErrorMax_m. The distance is NaN at instants
/// without a pose.
std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

}  // namespace tumble::tools
