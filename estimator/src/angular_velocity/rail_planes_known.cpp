// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "tumble/angular_velocity/detail/rail_planes.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

constexpr double kBeyondTolerance = 4.0;
constexpr int kMinContradictions = 2;
// maximum relative difference between the saturation levels of one device in two runs
constexpr double kSameShare = 0.003;

}  // namespace

RailPlanes RailPlaneFinder::merge_with_known_planes(const RailPlanes& found,
                                                    std::span<const Vector3d> readings_rad_s) const {
  RailPlanes out = found;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& earlier = params_.known.element[j];
    auto& rail = out.element[j];
    if (!earlier) continue;
    if (!rail && !earlier->contradicted_by(readings_rad_s)) rail = earlier;
    for (const int sign : {-1, 1}) {
      if (!rail || rail->seen(sign) || !earlier->seen(sign)) continue;
      const double apart = std::abs(rail->distance_rad_s - earlier->distance_rad_s);
      const std::size_t i = sign > 0 ? 1 : 0;
      if (apart <= kSameShare * earlier->distance_rad_s) rail->samples[i] = earlier->samples[i];
    }
  }
  return out;
}

bool RailPlane::contradicted_by(std::span<const Vector3d> readings_rad_s) const {
  int beyond = 0;
  for (const Vector3d& y : readings_rad_s) {
    for (const int sign : {-1, 1}) {
      beyond += seen(sign) && margin_rad_s(y, sign) < -kBeyondTolerance * tolerance_rad_s ? 1 : 0;
    }
  }
  return beyond >= kMinContradictions;
}

SensingDirections sensing_directions(const RailPlanes& planes, double unknown_sigma) {
  SensingDirections out;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const std::optional<RailPlane>& plane = planes.element[j];
    out.slope_sigma[i] = plane ? std::sqrt(0.5 * plane->covariance.topLeftCorner<2, 2>().trace()) : unknown_sigma;
    if (plane) out.rows.row(i) = plane->row.transpose();
  }
  return out;
}

// See rails.md (R54), (R55).
ElementClipping classify(const ImuSample& sample, const RailPlanes& planes) {
  ElementClipping out;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& rail = planes.element[j];
    if (!rail) continue;
    for (const int sign : {-1, 1}) {
      if (rail->holds(sample.angular_velocity_rad_s, sign)) out.sign[j] = static_cast<std::int8_t>(sign);
    }
  }
  return out;
}

void classify(std::span<const ImuSample> samples, const RailPlanes& planes, std::span<ElementClipping> out) {
  for (std::size_t k = 0; k < samples.size(); ++k) out[k] = classify(samples[k], planes);
}

}  // namespace tumble
