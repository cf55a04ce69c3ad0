// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/rail.hpp"

#include <algorithm>
#include <cmath>

#include "sim/imu/stages.hpp"

namespace tumble::sim {

namespace {

constexpr double kEventEnds_share = 0.9;

double wrapped(double value, double level) {
  return value - 2.0 * level * std::round(value / (2.0 * level));
}

}  // namespace

Rail::Rail(const Params& params, double period_s, const Stream& stream)
    : params_(params),
      fading_(params.recovery_s > 0.0 ? std::exp(-period_s / params.recovery_s) : 0.0),
      stream_(stream) {
  for (Axis& axis : axes_) {
    for (std::size_t side = 0; side < 2; ++side) {
      axis.base[side] = params_.level + bounded_normal(stream_, params_.axis_spread);
      axis.level[side] = draw_level(axis.base[side]);
    }
  }
}

double Rail::draw_level(double base) {
  return base + bounded_normal(stream_, params_.event_spread);
}

double Rail::apply(double input, Axis& axis, bool& acted) {
  const std::size_t side = input < 0.0 ? 1 : 0;
  for (std::size_t each = 0; each < 2; ++each) {
    const double outward = each == 0 ? input : -input;
    if (!axis.event[each] || outward >= kEventEnds_share * axis.level[each]) continue;
    axis.event[each] = false;
    axis.level[each] = draw_level(axis.base[each]);
  }
  const bool beyond = std::abs(input) > axis.level[side];
  axis.event[side] = axis.event[side] || beyond;
  if (params_.wrap) {
    acted = beyond;
    return beyond ? wrapped(input, axis.level[side]) : input;
  }
  const double shifted = input + axis.offset;
  const double output = std::clamp(shifted, -axis.level[1], axis.level[0]);
  acted = output != shifted;
  if (params_.recovery_s > 0.0) {
    const double target = beyond ? std::copysign(params_.recovery_share * axis.level[side], input) : 0.0;
    axis.offset = target + (axis.offset - target) * fading_;
  }
  return output;
}

Eigen::Vector3d Rail::operator()(const Eigen::Vector3d& input, int first_bit, std::uint8_t& flags) {
  if (params_.level <= 0.0) return input;
  Eigen::Vector3d output;
  for (int j = 0; j < 3; ++j) {
    bool acted = false;
    output[j] = apply(input[j], axes_[static_cast<std::size_t>(j)], acted);
    if (acted) flags = static_cast<std::uint8_t>(flags | (1u << (first_bit + j)));
  }
  return output;
}

}  // namespace tumble::sim
