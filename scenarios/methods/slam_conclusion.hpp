// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Computes the final results of a run over sweeps.
namespace tumble::scenarios {

/// Replaces the trajectory of a sweep by the smoothed trajectory, unless `smoothed` is empty.
void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// Result of the calibration check over all passes of a recording.
struct CalibrationVerdict {
  double moved = 0.0;  ///< distance from the initial calibration in its standard deviations
  bool converged = true;
};

/// Writes the final poses, map and status of a run; the estimate already contains the sweeps. All slam chains use this
/// function to decide whether the run is localised. The status is `too_few` if no sweep was registered. `localisation`
/// comes from the mapper's first report of each sweep. `scale` is null if the scale was not checked. Returns true if
/// the run is localised and completed.
bool conclude(const LidarInertialOdometry& odometry, const CalibrationVerdict& calibration,
              const Localisation& localisation, const SweepScale* scale, Estimate& estimate);

/// Completes a run that has a single pass. If the calibration moved by more than five of its stated standard
/// deviations, it is reported as wrong (health `lidar_calibration_mahalanobis`).
void conclude_sweeps(const LidarInertialOdometry& odometry, const StatedCalibration& given, const SweepScale& scale,
                     const Localisation& localisation, Estimate& estimate);

}  // namespace tumble::scenarios
