// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/replay/replay.hpp"

/// What the primary gyro said, and what others say of the same rate.
namespace tumble::tools {

/// At most `most` samples of the primary IMU: all of them, or of each run of equally many the fastest. Clipped axes are
/// those of the truth (scenarios/scoring/clipping.hpp), or of the device's flags where it sets any, or of the first
/// estimate with rates. Empty without an IMU. `truth` may be null.
ReplayStrip strip_of(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                     std::size_t most);

/// The true rate at the strip's samples; empty where the truth knows none.
std::vector<Eigen::Vector3f> true_rates(const ReplayStrip& strip, const sim::Sensors& sensors, const sim::Truth& truth);

/// An estimate's rates at the strip's samples, NaN where it has none within a period of the IMU; empty where it has no
/// rates.
std::vector<Eigen::Vector3f> estimated_rates(const ReplayStrip& strip, const sim::Sensors& sensors,
                                             const scenarios::Estimate& estimate);

}  // namespace tumble::tools
