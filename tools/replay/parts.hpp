// SPDX-License-Identifier: BSD-3-Clause
// This header declares the functions that compute the parts of a replay.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/replay/motion.hpp"
#include "tools/replay/replay.hpp"

namespace tumble::tools {

std::size_t triangle_count(const sim::MeshPart& part);

/// A height field keeps every node in the bounding box `near`; outside, the step between nodes is one eighth of their
/// distance from `near`.
std::vector<sim::MeshPart> thinned_world(std::vector<sim::MeshPart> parts, const Eigen::AlignedBox3f& near,
                                         std::size_t most, Shown& triangles);

/// A recording without a known robot shows a sphere of this radius, or a box of 0.3 m by 0.2 m by 0.1 m with a nose
/// along x.
std::vector<sim::MeshPart> plain_body(double sphere_radius_m);

/// Return i is selected if the fractional part of i times the golden ratio is below the wanted fraction; "every tenth
/// return" would always select the same beams of a 16-beam lidar. Returns from the robot's body are omitted: those that
/// the truth marks, or without a truth those nearer than 0.5 m.
ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most);

/// Transform from body axes of the estimator's calibration to body axes of the true mounting; the identity if the truth
/// has no lidar.
Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth);

std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface);

/// Selects at most `most` samples of the primary IMU: all, or the fastest of each group of equal size. Clipped axes
/// come from the truth, else from the device's flags if any is set, else from the first estimate with rates.
ReplayStrip strip_of(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                     std::size_t most);

std::vector<Eigen::Vector3f> true_rates(const ReplayStrip& strip, const sim::Sensors& sensors, const sim::Truth& truth);

std::vector<Eigen::Vector3f> estimated_rates(const ReplayStrip& strip, const sim::Sensors& sensors,
                                             const scenarios::Estimate& estimate);

}  // namespace tumble::tools
