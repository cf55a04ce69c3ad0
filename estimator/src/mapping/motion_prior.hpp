// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <variant>

#include "tumble/mapping/detail/odometer_reading.hpp"

namespace tumble::mapping {

struct Border;
struct MotionWindow;
struct Prediction;

/// Kinds of what is known of a sweep's motion beside the sweeps before it. A kind is a value with an `impose`, which
/// puts what it knows into the place of what was carried over the border, before the noise of the sweep is added; or
/// with a `weigh`, which holds it against what is predicted, once all noise is known.

/// Nothing: the velocity that the last sweep ended with, and the IMU from there.
struct InertialPrior {};

/// The velocity at the start, in IMU axes, and its standard deviation per axis, in the place of the last sweep's: a
/// robot that rolls.
struct KnownVelocity {
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
  double sigma_m_s = 0.0;
};

/// The velocity goes on, as far as a body that is struck now and then keeps it, and the gyro counts: an accelerometer
/// that is absent, or at its rail throughout. It needs neither of the two: the samples of the sweep are taken as those
/// of a gap are (InertialTrack::leave_out_force), and by that the noise is a gap's.
struct ConstantVelocity {};

using MotionPrior = std::variant<InertialPrior, KnownVelocity, OdometerReading, ConstantVelocity>;

/// Noise of position, attitude and velocity that arises within a sweep.
using MotionNoise = Eigen::Matrix<double, 9, 9>;

void impose(const KnownVelocity& prior, Prediction& prediction);
inline void impose(const MotionPrior& prior, Prediction& prediction) {
  if (const auto* const velocity = std::get_if<KnownVelocity>(&prior)) impose(*velocity, prediction);
}

/// Updates what is predicted of the sweep, `within` being a part of its noise, by a reading from within: mapping.md
/// (R107) to (R110). One from outside of the window, or that nothing can be made of, changes nothing.
void weigh_reading(const OdometerReading& reading, const Border& border, const MotionWindow& window,
                   const MotionNoise& within, Prediction& prediction);
inline void weigh(const MotionPrior& prior, const Border& border, const MotionWindow& window, const MotionNoise& within,
                  Prediction& prediction) {
  if (const auto* const reading = std::get_if<OdometerReading>(&prior))
    weigh_reading(*reading, border, window, within, prediction);
}

}  // namespace tumble::mapping
