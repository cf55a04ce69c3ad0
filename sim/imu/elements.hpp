// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/imu/rail.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Elements simulates the three sensing elements of a gyro or accelerometer. Each sensing element has its own axis,
/// scale, zero offset and saturation level. The sensing elements measure s = M u + o, with the true signal u in device
/// axes, misalignment matrix M and zero offset o. A saturation function c limits each component of s to the saturation
/// level of the sensing element. From the limited signals c(s), the device computes the reading M^-1 (c(s) - o), which
/// corrects misalignment and offset.
///
/// - While only one sensing element is saturated, the readings (x, y, z) are on a plane, perpendicular to the axis of
///   the sensing element.
/// - The saturation deficit is the signal of a sensing element minus its saturation level. A saturated sensing element
///   also changes the readings of the other axes, in proportion to its saturation deficit.
///
/// The simulation assumes that the device has the exact misalignment matrix and zero offset, and that the zero offset
/// does not drift within a recording.
class Elements {
 public:
  struct Params {
    /// Standard deviation of the off-diagonal entries of the misalignment matrix M, which are clamped to three standard
    /// deviations.
    double misalignment = 0.0;
    double scale = 0.0;   ///< standard deviation of the diagonal of M, around 1
    double offset = 0.0;  ///< standard deviation of o [signal unit]
  };
  static constexpr double kMisalignmentMax = 0.1;  ///< M is always invertible

  Elements() = default;
  Elements(const Params& params, Stream stream);
  Elements(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset);

  const Eigen::Matrix3d& axes() const { return axes_; }
  const Eigen::Vector3d& offset() const { return offset_; }
  bool axis_aligned() const { return axis_aligned_; }

  /// Limits a signal in device axes to the saturation levels, and sets bit `first_bit + i` of `flags` if sensing
  /// element i is saturated.
  Eigen::Vector3d clip(const Eigen::Vector3d& signal, Rail& rail, int first_bit, std::uint8_t& flags) const;

  Eigen::Vector3d with_elements_of(const Eigen::Vector3d& other, std::uint8_t mask,
                                   const Eigen::Vector3d& reading) const;

 private:
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity(), inverse_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  bool axis_aligned_ = true;
};

}  // namespace tumble::sim
