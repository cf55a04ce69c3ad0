// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// What a run over sweeps ends with.
namespace tumble::scenarios {

/// A sweep's smoothed trajectory, if there is one, takes the place of its first.
void apply_smoothed(std::vector<PoseState> smoothed, LidarInertialOdometry::SweepReport& sweep);

/// What the passes over a recording found of the calibration.
struct CalibrationVerdict {
  double moved = 0.0;  ///< from what was given, in its standard deviations
  bool converged = true;
};

/// Poses, map and verdict of a run whose sweeps and their ends the estimate holds: the one place that says whether it
/// is localised; `too_few` when no sweep was registered. `localisation`: of the sweeps as the mapper first told of
/// them. `scale`: null where it was not asked for. Returns whether the run is localised and went through.
bool conclude(const LidarInertialOdometry& odometry, const CalibrationVerdict& calibration,
              const Localisation& localisation, const SweepScale* scale, Estimate& estimate);

/// The same of one pass. A calibration that has moved by more than five of the deviations with which it was given was
/// given wrong (health `lidar_calibration_mahalanobis`).
void conclude_sweeps(const LidarInertialOdometry& odometry, const GivenCalibration& given, const SweepScale& scale,
                     const Localisation& localisation, Estimate& estimate);

}  // namespace tumble::scenarios
