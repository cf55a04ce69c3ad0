// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <variant>

namespace tumble::mapping {

struct Prediction;

/// Kinds of what is known of a sweep's motion beside the sweeps before it. A kind is a value and an `impose`, which
/// puts what it knows into the place of what was carried over the border; it is called before the noise of the sweep is
/// added. Another kind (a constant velocity, a pose of the caller's) is a struct and its `impose` in a file of its own,
/// and a line in MotionPrior.

/// Nothing: the velocity that the last sweep ended with, and the IMU from there.
struct InertialPrior {};

/// The velocity at the start, in IMU axes, and its standard deviation per axis: an odometer, a robot that rolls.
struct KnownVelocity {
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
  double sigma_m_s = 0.0;
};

using MotionPrior = std::variant<InertialPrior, KnownVelocity>;

void impose(const InertialPrior& prior, Prediction& prediction);
void impose(const KnownVelocity& prior, Prediction& prediction);
inline void impose(const MotionPrior& prior, Prediction& prediction) {
  std::visit([&](const auto& kind) { impose(kind, prediction); }, prior);
}

}  // namespace tumble::mapping
