// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/imu/rail.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Elements models the sensing elements of a triad (gyroscope or accelerometer), each with its own axis, scale, zero
/// offset and saturation level. Sensing element i measures s_i = m_i . u + o_i, with the signal u in device axes, the
/// row m_i of the misalignment matrix M, and the zero offset o_i. The device saturates s to c(s), then subtracts the
/// offset and inverts the matrix: the reading is y = M^-1 (c(s) - o).
///
/// - While only sensing element j is at its limit r, the readings y lie on one of two tilted planes, m_j . y = +r - o_j
///   or -r - o_j.
/// - A saturated sensing element also changes the readings of the other axes, by entries of M^-1 times its saturation
///   deficit.
///
/// Measured devices show planes tilted by 0.02 and 0.05, and offsets of 0.05 and 0.14 rad/s
/// (scenarios/certificate/real_rails.cpp). The model of the sensing elements excludes compensation errors that differ
/// at saturation, and offsets that drift within a recording.
class Elements {
 public:
  struct Params {
    /// Standard deviation of each entry off M's diagonal [1], truncated at three standard deviations
    double misalignment = 0.0;
    double scale = 0.0;   ///< of the diagonal, about 1
    double offset = 0.0;  ///< of the offset o [signal unit]
  };
  static constexpr double kMisalignmentMax = 0.1;  ///< M is always invertible

  Elements() = default;
  Elements(const Params& params, Stream stream);
  Elements(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset);

  const Eigen::Matrix3d& axes() const { return axes_; }
  const Eigen::Vector3d& offset() const { return offset_; }
  bool axis_aligned() const { return axis_aligned_; }

  /// Sets bit `first_bit + i` of `flags` if sensing element i saturated.
  Eigen::Vector3d clip(const Eigen::Vector3d& signal, Rail& rail, int first_bit, std::uint8_t& flags) const;

  Eigen::Vector3d with_elements_of(const Eigen::Vector3d& other, std::uint8_t mask,
                                   const Eigen::Vector3d& reading) const;

 private:
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity(), inverse_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  bool axis_aligned_ = true;
};

}  // namespace tumble::sim
