// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/attitude/detail/spin_tracker.hpp"

namespace tumble {

// This file contains two measurement models of a steady spin: Modulation and Centripetal. The first two states of each
// model are the rate and the angular acceleration about the spin axis. The parameter `related` is 1 in the filter for a
// steady spin, and 0 in the filter for other motion. Only the filter for a steady spin rotates world-fixed vectors in
// the state by the spin angle.

template <int N>
struct SpinPrediction {
  Eigen::Matrix<double, N, 1> x;
  Eigen::Matrix<double, N, N> covariance, transition_matrix;
};

/// SpinReading splits one IMU sample into the gyro reading about the spin axis, and the readings of the two axes
/// perpendicular to the spin axis. The spin axis and the two perpendicular axes, in this order, form a right-handed
/// frame.
struct SpinReading {
  double rate_rad_s = 0.0;
  bool saturated = false;
  Eigen::Vector2d across = Eigen::Vector2d::Zero();  ///< gyro [rad/s] or accelerometer [m/s^2]
  bool across_valid = false;
  double dt_s = 0.0;
};

/// Modulation models the transverse rate (perpendicular to the spin axis), equations (C44) and (C45) of carried.md. The
/// states are:
/// - the rate and the angular acceleration about the spin axis,
/// - the part of the transverse rate that is constant in world axes: two components, in body axes,
/// - the part of the transverse rate that is constant in body axes: two components, in body axes.
struct Modulation {
  static constexpr int kStates = 6;
  using Filter = SpinFilter<kStates>;

  SpinReading reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const;
  Filter start(const SpinReading& reading) const;
  SpinPrediction<kStates> predict(const Filter& filter, double related, double dt_s) const;
  double update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double related,
                Filter& filter) const;
};

/// Centripetal models the specific force perpendicular to the spin axis, equations (C49) and (C50) of carried.md. The
/// states are the rate, the angular acceleration, and three vectors. Each vector has two components perpendicular to
/// the spin axis, in body axes:
/// - the lever arm,
/// - the external force that is constant in the body,
/// - the external force that is constant in the world.
struct Centripetal {
  static constexpr int kStates = 8;
  using Filter = SpinFilter<kStates>;

  SpinReading reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const;
  Filter start(const SpinReading& reading) const;
  SpinPrediction<kStates> predict(const Filter& filter, double related, double dt_s) const;
  double update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double related,
                Filter& filter) const;
};

}  // namespace tumble
