// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// Return i is selected if the fractional part of i times the golden ratio is below the wanted fraction; "every tenth
/// return" would always select the same beams of a 16-beam lidar. Returns from the robot's body are omitted: those that
/// the truth marks, or without a truth those nearer than 0.5 m.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// Transform from body axes of the estimator's calibration to body axes of the true mounting; the identity if the truth
/// has no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

}  // namespace tumble::tools
