// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/elements.hpp"

#include <Eigen/LU>

#include "sim/imu/stages.hpp"

namespace tumble::sim {

namespace {

Eigen::Matrix3d draw_axes(Stream& stream, const Elements::Params& params) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      axes(row, column) += bounded_normal(stream, row == column ? params.scale : params.misalignment);
    }
  }
  return axes;
}

Eigen::Vector3d draw_offset(Stream& stream, double sigma) {
  Eigen::Vector3d offset;
  for (int axis = 0; axis < 3; ++axis) offset[axis] = bounded_normal(stream, sigma);
  return offset;
}

}  // namespace

Elements::Elements(const Params& params, Stream stream) {
  const Eigen::Matrix3d axes = draw_axes(stream, params);
  *this = Elements(axes, draw_offset(stream, params.offset));
}

Elements::Elements(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset)
    : axes_(axes),
      inverse_(axes.inverse()),
      offset_(offset),
      axis_aligned_(axes.isIdentity(0.0) && offset.isZero(0.0)) {}

Eigen::Vector3d Elements::clip(const Eigen::Vector3d& signal, Rail& rail, int first_bit, std::uint8_t& flags) const {
  if (axis_aligned_) return rail(signal, first_bit, flags);
  const Eigen::Vector3d sensed = axes_ * signal + offset_;
  const Eigen::Vector3d clipped = rail(sensed, first_bit, flags);
  if (clipped == sensed) return signal;
  return signal + inverse_ * (clipped - sensed);
}

Eigen::Vector3d Elements::with_elements_of(const Eigen::Vector3d& other, std::uint8_t mask,
                                           const Eigen::Vector3d& reading) const {
  Eigen::Vector3d out = reading;
  if (axis_aligned_) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((mask >> axis & 1) != 0) out[axis] = other[axis];
    }
    return out;
  }
  if (mask == 0) return out;
  Eigen::Vector3d change = axes_ * (other - reading);
  for (int element = 0; element < 3; ++element) {
    if ((mask >> element & 1) == 0) change[element] = 0.0;
  }
  return out + inverse_ * change;
}

}  // namespace tumble::sim
