// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/imu/rail.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// The sensing elements of a triad: each along an axis of its own, with its own scale and zero offset, and each with
/// its own rail. Let u be the signal in the device's axes, all errors but the rail's included. Element i senses
/// s_i = m_i . u + o_i, row i of M; the rail takes s to c(s); the device takes the offset off again and undoes the
/// matrix: y = M^-1 (c(s) - o). So
///   - while no element meets its rail the reading is u, bit for bit: neither M nor o can be seen;
///   - while element j alone is at its rail r, m_j . y = +r - o_j or -r - o_j: the rail is a plane in the readings,
///     tilted against the axes, not the same for the two signs;
///   - the axes beside it are wrong too, by entries of M^-1 times the deficit, while m_i . y = m_i . u still holds for
///     the free elements.
/// Seen on real devices: planes tilted by 0.02 and 0.05, offsets of 0.05 and 0.14 rad/s (RepoIMU, the wand and the
/// pendulum; scenarios/certificate/real_rails.cpp has the figures).
/// What it does not model: noise and quantum of their own along the elements' axes (both stay in the device's), a
/// compensation that errs at the rail other than elsewhere (its errors are in u), offsets that drift within a
/// recording.
class Elements {
 public:
  struct Params {
    double misalignment = 0.0;  ///< of each entry off M's diagonal [1]: standard deviation, cut at three of them
    double scale = 0.0;         ///< of each entry on the diagonal, about 1: the same
    double offset = 0.0;        ///< of each element's o: the same [unit of the signal]
  };
  static constexpr double kMostMisalignment =
      0.1;  ///< up to here, and for the scale, M can be inverted whatever is drawn

  /// Upright: M the identity, no offset.
  Elements() = default;
  /// Drawn; nothing from `stream` for what is 0.
  Elements(const Params& params, Stream stream);
  /// As given: `axes` is M, which must have an inverse.
  Elements(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset);

  const Eigen::Matrix3d& axes() const { return axes_; }
  const Eigen::Vector3d& offset() const { return offset_; }
  /// M is the identity, and there is no offset.
  bool upright() const { return upright_; }

  /// The device's reading of `signal` behind `rail`, both in the device's axes; sets bit `first_bit + i` of `flags`
  /// where the rail of element i acted. Upright: the rail's own output.
  Eigen::Vector3d clip(const Eigen::Vector3d& signal, Rail& rail, int first_bit, std::uint8_t& flags) const;

  /// `reading`, but with what the elements in `mask` (bit i) say taken from `other`.
  Eigen::Vector3d with_elements_of(const Eigen::Vector3d& other, std::uint8_t mask,
                                   const Eigen::Vector3d& reading) const;

 private:
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity(), inverse_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  bool upright_ = true;
};

}  // namespace tumble::sim
