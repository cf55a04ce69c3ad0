// SPDX-License-Identifier: BSD-3-Clause
#include "near_saturation_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tumble {

namespace {

// A gyro's low-pass filter may lower the first and last saturated readings, by up to 2 % in one hand-held device.
constexpr std::size_t kReach = 2;
constexpr double kRoundedPeakRatio = 0.03;

using Rates = std::span<const Eigen::Vector3d>;

double largest_step(Rates readings, std::size_t at, std::size_t reach, Eigen::Index axis) {
  double out = 0.0;
  const std::size_t last = std::min(readings.size() - 1, at + reach);
  for (std::size_t i = at - std::min(at, reach); i < last; ++i)
    out = std::max(out, std::abs(readings[i + 1][axis] - readings[i][axis]));
  return out;
}

// See rails.md (R76).
std::uint8_t axes_near_saturation_limits(Rates readings, std::size_t at, const SaturationPlanes& planes) {
  const Eigen::Vector3d& reading = readings[at];
  std::uint8_t out = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto axis = static_cast<Eigen::Index>(j);
    const auto& rail = planes.sensing_axis[j];
    const int sign = reading[axis] < 0.0 ? -1 : 1;
    if (!rail || !rail->was_reached(sign)) continue;
    const double missing = rail->distance_to_plane_rad_s(reading, sign);
    const std::size_t reach = missing < kRoundedPeakRatio * rail->saturation_limit_rad_s ? kReach : 1;
    if (missing < largest_step(readings, at, reach, axis)) out = static_cast<std::uint8_t>(out | 1u << j);
  }
  return out;
}

}  // namespace

std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const SaturationPlanes& planes) {
  std::array<Eigen::Vector3d, 3> readings;
  std::size_t count = 0, at = 0;
  if (before != nullptr) readings[count++] = before->angular_velocity_rad_s;
  at = count;
  readings[count++] = now.angular_velocity_rad_s;
  if (after != nullptr) readings[count++] = after->angular_velocity_rad_s;
  return axes_near_saturation_limits(Rates(readings.data(), count), at, planes);
}

std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples,
                                                      const SaturationPlanes& planes) {
  std::vector<std::uint8_t> out(samples.size(), 0);
  if (!planes.any_plane_found()) return out;
  std::vector<Eigen::Vector3d> readings;
  std::vector<std::size_t> of_sample(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::Vector3d& reading = samples[k].angular_velocity_rad_s;
    if (readings.empty() || readings.back() != reading) readings.push_back(reading);
    of_sample[k] = readings.size() - 1;
  }
  for (std::size_t k = 0; k < samples.size(); ++k) out[k] = axes_near_saturation_limits(readings, of_sample[k], planes);
  return out;
}

}  // namespace tumble
