// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/imu/rail.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Elements models the sensing elements of a triad (gyroscope or accelerometer), each with its own axis, scale, zero
/// offset and saturation level. Let u be the signal in the device's axes, with all errors except saturation. Sensing
/// element i measures s_i = m_i . u + o_i, where m_i is row i of the misalignment matrix M, and o_i is the zero offset.
/// Saturation maps the vector s to c(s). The device then subtracts the offset and inverts the matrix: the reading is y
/// = M^-1 (c(s) - o).
///
/// - While only element j is at its limit r, the reading satisfies m_j . y = +r - o_j or -r - o_j, so the saturated
///   readings are on two tilted planes.
/// - While element j is at its limit, the other axes are also wrong, by entries of M^-1 times the saturation deficit of
///   element j.
///
/// Measured devices show planes tilted by 0.02 and 0.05, and offsets of 0.05 and 0.14 rad/s
/// (scenarios/certificate/real_rails.cpp). The model excludes compensation errors that differ at saturation, and
/// offsets that drift within a recording.
class Elements {
 public:
  struct Params {
    /// Standard deviation of each entry off M's diagonal [1], truncated at three standard deviations
    double misalignment = 0.0;
    double scale = 0.0;   ///< standard deviation of each entry on the diagonal, about 1
    double offset = 0.0;  ///< standard deviation of each element's offset o [unit of the signal]
  };
  static constexpr double kMisalignmentMax = 0.1;  ///< upper bound of both spreads, for which M is always invertible

  Elements() = default;
  Elements(const Params& params, Stream stream);
  Elements(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset);

  const Eigen::Matrix3d& axes() const { return axes_; }
  const Eigen::Vector3d& offset() const { return offset_; }
  bool axis_aligned() const { return axis_aligned_; }

  /// Sets bit `first_bit + i` of `flags` if element i saturated.
  Eigen::Vector3d clip(const Eigen::Vector3d& signal, Rail& rail, int first_bit, std::uint8_t& flags) const;

  Eigen::Vector3d with_elements_of(const Eigen::Vector3d& other, std::uint8_t mask,
                                   const Eigen::Vector3d& reading) const;

 private:
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity(), inverse_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  bool axis_aligned_ = true;
};

}  // namespace tumble::sim
