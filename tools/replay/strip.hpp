// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/replay.hpp"

/// strip.hpp provides readings of the primary gyro, and the rates of truth and estimates in gyro axes.
namespace tumble::tools {

/// Selects at most `most` samples of the primary IMU: all, or the fastest of each group of equal size. Clipped axes
/// come from the truth (scenarios/scoring/clipping.hpp), else from the device's flags if any is set, else from the
/// first estimate with rates. The strip is empty without an IMU. `truth` may be null.
ReplayStrip strip_of(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                     std::size_t most);

/// Returns the true rate at the samples of the strip; empty if the truth has no rates.
std::vector<Eigen::Vector3f> true_rates(const ReplayStrip& strip, const sim::Sensors& sensors, const sim::Truth& truth);

/// Returns the rates of an estimate at the samples of the strip. A rate is NaN if the estimate has no rate within one
/// IMU period. The list is empty if the estimate has no rates.
std::vector<Eigen::Vector3f> estimated_rates(const ReplayStrip& strip, const sim::Sensors& sensors,
                                             const scenarios::Estimate& estimate);

}  // namespace tumble::tools
