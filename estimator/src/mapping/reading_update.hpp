// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

struct SweepBoundary;
struct MotionWindow;
struct Prediction;

/// process noise covariance of position, attitude and velocity within a sweep
using MotionNoise = Eigen::Matrix<double, 9, 9>;

/// Updates the prediction of a sweep with an odometer reading that was measured during the sweep: mapping.md (R34) to
/// (R37). An odometer reading from a time outside of the sweep has no effect.
void fuse_reading(const OdometerReading& reading, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction);

}  // namespace tumble::mapping
