// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

/// Selects at most `most` samples of the primary IMU: all, or the fastest of each group of equal size. Clipped axes
/// come from the truth, else from the device's flags if any is set, else from the first estimate with rates.
ReplayStrip strip_of(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                     std::size_t most);

std::vector<Eigen::Vector3f> true_rates(const ReplayStrip& strip, const sim::Sensors& sensors, const sim::Truth& truth);

std::vector<Eigen::Vector3f> estimated_rates(const ReplayStrip& strip, const sim::Sensors& sensors,
                                             const scenarios::Estimate& estimate);

}  // namespace tumble::tools
