// SPDX-License-Identifier: BSD-3-Clause
#include "possible_saturation.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/rail_ratios.hpp"

namespace tumble {

namespace {

// maximum relative tilt of the planes that contain the saturated readings of two sensing elements
constexpr double kMaxPlaneTilt = 0.06, kDeficitStepRatio = 0.5;

constexpr double kTopRatio = 0.01, kMaxElementSigmas = 3.0;

double lowest_saturation_limit(const SaturationPlanes& planes) {
  double rail = 0.0;
  for (const auto& element : planes.sensing_axis) {
    if (element && (rail == 0.0 || element->saturation_limit_rad_s < rail)) rail = element->saturation_limit_rad_s;
  }
  return rail;
}

// Returns how far the rate may exceed `count` equal readings at a maximum: rails.md (R74).
double rise_above_plateau(double count, double entered, double left) {
  const double both = std::max(0.0, entered) + std::max(0.0, left);
  return both > 0.0 ? count * std::max(0.0, entered) * std::max(0.0, left) / both : 0.0;
}

// If the saturation plane (SaturationPlane) of an axis is tilted, rotation about the other axes changes the saturated
// readings by the tilt times the rotation rate.
double rate_of_other_axes(const Eigen::Vector3d& rate_rad_s, Eigen::Index axis) {
  return std::hypot(rate_rad_s[(axis + 1) % 3], rate_rad_s[(axis + 2) % 3]);
}

}  // namespace

// The saturation level of a sensing element is at least as large as each of its readings: rails.md (R75).
void MinSaturationLevels::add(const Eigen::Vector3d& rate_rad_s) {
  for (Eigen::Index j = 0; j < 3; ++j) {
    double& least = min_levels_rad_s_[rate_rad_s[j] < 0.0 ? 0 : 1][j];
    least = std::max(least, std::abs(rate_rad_s[j]) - kMaxPlaneTilt * rate_of_other_axes(rate_rad_s, j));
  }
}

bool MinSaturationLevels::is_below_min_saturation_level(const Eigen::Vector3d& rate_rad_s, Eigen::Index axis) const {
  const double least = min_levels_rad_s_[rate_rad_s[axis] < 0.0 ? 0 : 1][axis];
  return std::abs(rate_rad_s[axis]) + kMaxPlaneTilt * rate_of_other_axes(rate_rad_s, axis) <
         (1.0 - kNearRailRatio) * least;
}

void inflate_covariance_near_limits(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                                    const ImuSample* after) {
  const double rail = lowest_saturation_limit(planes);
  now.rarely_high_axes = 0;
  if (rail == 0.0) return;
  const Eigen::Vector3d& reading = now.sample.angular_velocity_rad_s;
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto& own = planes.sensing_axis[static_cast<std::size_t>(j)];
    const int sign = reading[j] < 0.0 ? -1 : 1;
    const unsigned unusable = now.clipping.gyro | now.clipping.unusable_gyro | now.partial_saturation_flags;
    if ((own && own->was_reached(sign)) || (unusable >> j & 1u) != 0) continue;
    const double beside = rate_of_other_axes(reading, j);
    if (std::abs(reading[j]) < (1.0 - kNearRailRatio) * rail - kMaxPlaneTilt * beside) continue;
    if (least.is_below_min_saturation_level(reading, j)) continue;
    double step = 0.0;
    for (const ImuSample* neighbour : {before, after}) {
      if (neighbour == nullptr) continue;
      step = std::max(step, std::abs(reading[j] - neighbour->angular_velocity_rad_s[j]));
    }
    now.rarely_high_axes = static_cast<std::uint8_t>(now.rarely_high_axes | 1u << j);
    now.saturation_deficit_sigma_rad_s[j] = std::hypot(noise_rad_s, kDeficitStepRatio * step);
  }
}

void inflate_covariance_at_plateaus(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double offset_sigma_ratio, double noise_rad_s,
                                    std::span<AngularRateObservation> observations) {
  const double from = (1.0 - kMaxElementSigmas * offset_sigma_ratio) * lowest_saturation_limit(planes);
  const bool flags = std::any_of(observations.begin(), observations.end(),
                                 [](const AngularRateObservation& o) { return o.sample.device_clip_flags != 0; });
  if (!(from > 0.0) || flags) return;
  const std::size_t count = observations.size();
  for (std::size_t j = 0; j < 3; ++j) {
    const auto axis = static_cast<Eigen::Index>(j);
    for (const int sign : {-1, 1}) {
      const auto& own = planes.sensing_axis[j];
      if (own && own->was_reached(sign)) continue;
      const auto value = [&](std::size_t k) { return sign * observations[k].sample.angular_velocity_rad_s[axis]; };
      for (std::size_t k = 0; k < count;) {
        if (value(k) < from) {
          ++k;
          continue;
        }
        std::size_t first = k, last = k;
        double top = value(k);
        while (last + 1 < count && value(last + 1) >= (1.0 - kTopRatio) * top) top = std::max(top, value(++last));
        while (value(first) < (1.0 - kTopRatio) * top) ++first;
        k = last + 1;
        if (first == 0 || last + 1 == count || first == last) continue;
        const double rise =
            rise_above_plateau(static_cast<double>(last - first + 1), top - value(first - 1), top - value(last + 1));
        if (!(rise > 0.0)) continue;  // the readings have no maximum
        if (least.is_below_min_saturation_level(observations[first].sample.angular_velocity_rad_s, axis)) continue;
        for (std::size_t i = first; i <= last; ++i) {
          AngularRateObservation& o = observations[i];
          if (((o.clipping.gyro | o.clipping.unusable_gyro) >> j & 1u) != 0) continue;
          const double sigma =
              (o.rarely_high_axes >> j & 1u) != 0 ? o.saturation_deficit_sigma_rad_s[axis] : noise_rad_s;
          o.rarely_high_axes = static_cast<std::uint8_t>(o.rarely_high_axes & ~(1u << j));
          o.suspected_saturation = static_cast<std::uint8_t>(o.suspected_saturation | 1u << j);
          o.saturation_deficit_sigma_rad_s[axis] = std::hypot(sigma, kDeficitStepRatio * rise);
        }
      }
    }
  }
}

}  // namespace tumble
