// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// Selects at most `most` returns of the first lidar, spread evenly over sweeps and beams. Return i is selected if the
/// fractional part of i times the golden ratio is below the wanted fraction; "every tenth return" would always select
/// the same beams of a 16-beam lidar. Returns from the robot's body are omitted: those that the truth marks, or without
/// a truth those nearer than 0.5 m.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// Returns the transform from body axes of the estimator's calibration to body axes of the true mounting; the identity
/// if the truth has no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

/// Returns the distance of each point to the true surface [m], at most kMapErrorMax_m; NaN at times without a pose.
std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

}  // namespace tumble::tools
