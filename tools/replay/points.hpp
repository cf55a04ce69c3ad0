// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

/// The returns of a lidar that a replay shows, and how far from the true surface somebody's motion places them.
namespace tumble::tools {

/// At most `most` returns of the first lidar, spread evenly over its sweeps and beams: return i of those that are not
/// the robot's own is one of them when the fraction of i times the golden ratio is below the share wanted (an additive
/// recurrence, which keeps no beam out, as every tenth of 16 beams would). The robot's own are those that the truth
/// calls so; without truth what is nearer than 0.5 m. Empty without a lidar. `truth` may be null.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// From body axes by the calibration given to those by the true mounting; the identity where the truth knows no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

/// Distance of each point to the true surface [m], at most kMapErrorMax_m; NaN where the motion does not know where the
/// robot was.
std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

}  // namespace tumble::tools
