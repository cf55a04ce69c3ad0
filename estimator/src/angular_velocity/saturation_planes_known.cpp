// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

constexpr double kBeyondTolerance = 4.0;
constexpr int kMinContradictions = 2;
// maximum relative difference between the saturation levels of one device in two runs
constexpr double kSameShare = 0.003;

}  // namespace

SaturationPlanes SaturationPlaneFinder::merge_known_saturation_planes(const SaturationPlanes& found,
                                                                      std::span<const Vector3d> readings_rad_s) const {
  SaturationPlanes out = found;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& earlier = params_.known_limits.sensing_axis[j];
    auto& rail = out.sensing_axis[j];
    if (!earlier) continue;
    if (!rail && !earlier->is_contradicted_by_readings(readings_rad_s)) rail = earlier;
    for (const int sign : {-1, 1}) {
      if (!rail || rail->was_reached(sign) || !earlier->was_reached(sign)) continue;
      const double apart = std::abs(rail->saturation_limit_rad_s - earlier->saturation_limit_rad_s);
      const std::size_t i = sign > 0 ? 1 : 0;
      if (apart <= kSameShare * earlier->saturation_limit_rad_s) rail->samples[i] = earlier->samples[i];
    }
  }
  return out;
}

bool SaturationPlane::is_contradicted_by_readings(std::span<const Vector3d> readings_rad_s) const {
  int beyond = 0;
  for (const Vector3d& y : readings_rad_s) {
    for (const int sign : {-1, 1}) {
      beyond += was_reached(sign) && distance_to_plane_rad_s(y, sign) < -kBeyondTolerance * tolerance_rad_s ? 1 : 0;
    }
  }
  return beyond >= kMinContradictions;
}

SensingDirections sensing_directions(const SaturationPlanes& planes, double unknown_sigma) {
  SensingDirections out;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const std::optional<SaturationPlane>& plane = planes.sensing_axis[j];
    out.cross_axis_slope_sigma[i] =
        plane ? std::sqrt(0.5 * plane->covariance.topLeftCorner<2, 2>().trace()) : unknown_sigma;
    if (plane) out.sensing_directions.row(i) = plane->row.transpose();
  }
  return out;
}

}  // namespace tumble
