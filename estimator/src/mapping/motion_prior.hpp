// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <variant>

#include "tumble/mapping/detail/odometer_reading.hpp"

namespace tumble::mapping {

struct SweepBoundary;
struct MotionWindow;
struct Prediction;

/// motion_prior.hpp defines kinds of information about a sweep's motion, in addition to the previous sweeps. Each kind
/// of information is a type with a function `apply_velocity_prior` or `weigh`. The function `apply_velocity_prior`
/// replaces the state at the sweep boundary, before the sweep's noise is added. The function `weigh` fuses a
/// measurement with the prediction, after all noise is added.

/// InertialPrior provides no additional information: the velocity at the end of the last sweep continues by the IMU.
struct InertialPrior {};

/// KnownVelocity is the velocity at the start of the sweep, in IMU axes, with its standard deviation per axis. The
/// known velocity replaces the velocity of the last sweep, for example for a rolling robot.
struct KnownVelocity {
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
  double sigma_m_s = 0.0;
};

/// ConstantVelocity assumes a constant velocity with the uncertainty of impacts, for an accelerometer that is absent or
/// always saturated. With ConstantVelocity, the gyro is still used. ConstantVelocity needs neither
/// `apply_velocity_prior` nor `weigh`, because its samples are treated like the samples of a gap
/// (InertialTrack::exclude_accelerometer). The gap also determines the noise.
struct ConstantVelocity {};

using MotionPrior = std::variant<InertialPrior, KnownVelocity, OdometerReading, ConstantVelocity>;

/// Process noise of position, attitude and velocity within a sweep.
using MotionNoise = Eigen::Matrix<double, 9, 9>;

void apply_velocity_prior(const KnownVelocity& prior, Prediction& prediction);
inline void apply_velocity_prior(const MotionPrior& prior, Prediction& prediction) {
  if (const auto* const velocity = std::get_if<KnownVelocity>(&prior)) apply_velocity_prior(*velocity, prediction);
}

/// Updates the prediction of a sweep by a reading from within the sweep, see mapping.md (R34) to (R37). `within` is a
/// part of the sweep's noise. An unusable reading, or a reading outside of the window, has no effect.
void fuse_reading(const OdometerReading& reading, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction);
inline void weigh(const MotionPrior& prior, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction) {
  if (const auto* const reading = std::get_if<OdometerReading>(&prior))
    fuse_reading(*reading, boundary, window, within, prediction);
}

}  // namespace tumble::mapping
