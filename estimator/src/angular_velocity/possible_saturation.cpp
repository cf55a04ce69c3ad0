// SPDX-License-Identifier: BSD-3-Clause
#include "possible_saturation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"

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

// largest saturated fraction of the averaging window for which a reading still determines the slope of the rate
constexpr double kSaturatedFractionMax = 0.85;
constexpr double kDeficitSigmaRatio = 0.5, kDepthSigmaRatio = 0.25, kDepthMax = 1.0;

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

// The rate is assumed to cross the saturation level with constant slope: rails.md (R69), (R70).
PartialSaturation partial_saturation(double reading_rad_s, double neighbour_rad_s, double rail_rad_s,
                                     double noise_rad_s) {
  const double depth = rail_rad_s - reading_rad_s, slope = reading_rad_s - neighbour_rad_s;
  // Noise lowers a fully saturated reading by less than a tenth of the noise's standard deviation, because the device
  // clips the sum of rate and noise.
  if (!(depth > 0.1 * noise_rad_s)) return {};
  // If the device compensates misalignment after clipping, rotation about other axes slowly changes a fully saturated
  // reading. Only a change above the noise indicates partial saturation.
  if (!(slope > noise_rad_s)) return {};
  double share = 0.0;  // rails.md (R71)
  if (slope > 2.0 * depth) {
    const double ratio = depth / slope;
    const double root = std::sqrt(std::max(0.0, 1.0 - (1.0 + ratio) * (1.0 - 2.0 * ratio)));
    share = (1.0 - root) / (1.0 + ratio);
  }
  if (share > kSaturatedFractionMax) return {};
  // See rails.md (R72), (R73).
  const double free = 1.0 - share, lost = share * share / (free * free) * depth;
  return {true, lost,
          std::hypot(2.0 * noise_rad_s, kDeficitSigmaRatio * lost + kDepthSigmaRatio * std::min(depth, kDepthMax))};
}

}  // namespace tumble
