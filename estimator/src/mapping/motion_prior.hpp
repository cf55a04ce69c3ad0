// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <variant>

#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

struct SweepBoundary;
struct MotionWindow;
struct Prediction;

/// `apply_velocity_prior` runs before the process noise of the sweep is added, and `weigh_with_motion_prior`
/// afterwards.

/// With InertialPrior, the IMU alone propagates the velocity from the end of the last sweep.
struct InertialPrior {};

/// KnownVelocity replaces the velocity at the start of the sweep, in IMU axes, for example for a rolling robot.
struct KnownVelocity {
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
  double sigma_m_s = 0.0;
};

/// ConstantVelocity is for an absent or always saturated accelerometer. The velocity is assumed constant, with the
/// uncertainty that impacts cause.
struct ConstantVelocity {};

using MotionPrior = std::variant<InertialPrior, KnownVelocity, OdometerReading, ConstantVelocity>;

/// process noise covariance of position, attitude and velocity within a sweep
using MotionNoise = Eigen::Matrix<double, 9, 9>;

void apply_velocity_prior(const KnownVelocity& prior, Prediction& prediction);
inline void apply_velocity_prior(const MotionPrior& prior, Prediction& prediction) {
  if (const auto* const velocity = std::get_if<KnownVelocity>(&prior)) apply_velocity_prior(*velocity, prediction);
}

/// Updates the prediction of a sweep with an odometer reading from within the sweep: mapping.md (R34) to (R37).
/// Odometer readings outside of the sweep have no effect.
void fuse_reading(const OdometerReading& reading, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction);
inline void weigh_with_motion_prior(const MotionPrior& prior, const SweepBoundary& boundary, const MotionWindow& window,
                                    const MotionNoise& within, Prediction& prediction) {
  if (const auto* const reading = std::get_if<OdometerReading>(&prior))
    fuse_reading(*reading, boundary, window, within, prediction);
}

}  // namespace tumble::mapping
