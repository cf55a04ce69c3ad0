// SPDX-License-Identifier: BSD-3-Clause
#include "possible_saturation.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

namespace {

constexpr double kDeterminedSlopeSigma = 2e-3, kNegligibleSlope = 3e-3;
constexpr double kUnequalLevelsRatio = 1e-4;
constexpr double kUprightSigma = 1e-5, kSlopeSigmaMin = 3e-4;
// A reading counts as partly saturated if its distance from the saturation level is less than kEdgeStepRatio times its
// distance from the adjacent unsaturated reading.
constexpr double kEdgeStepRatio = 0.5;

int half_range_side(const ImuSample& sample, Triad triad, std::size_t j) {
  return triad_reading_of(sample, triad)[static_cast<Eigen::Index>(j)] < 0.0 ? -1 : 1;
}

// A reading is saturated if the device flags the sample, or if the reading is at or beyond the positive or negative
// saturation limit of the sensing element: rails.md (R55).
bool is_at_saturation_limit(const ImuSample& sample, Triad triad, const SaturationPlane& rail, std::size_t j) {
  const Eigen::Vector3d& reading = triad_reading_of(sample, triad);
  return (sample.device_clip_flags >> (first_channel(triad) + j) & 1u) != 0 || rail.is_saturated(reading, -1) ||
         rail.is_saturated(reading, 1);
}

// A sample next to a clipped sample may be saturated for a part of its averaging window: rails.md (R54).
bool reaches_limit(const SaturationPlane& rail, Triad triad, const ImuSample& now, const ImuSample* outside, int sign) {
  const double depth = rail.distance_to_plane_rad_s(triad_reading_of(now, triad), sign);
  if (depth > kNearRailRatio * rail.saturation_limit_rad_s) return false;
  if (outside == nullptr) return true;
  const double before = rail.distance_to_plane_rad_s(triad_reading_of(*outside, triad), sign);
  return depth < kEdgeStepRatio * (before - depth);
}

// The positive and negative saturation levels differ if the device subtracts the offset after clipping.
bool has_unequal_limits(const SaturationPlane& rail) {
  return rail.was_reached(-1) && rail.was_reached(1) &&
         std::abs(rail.offset_rad_s) >
             kUnequalLevelsRatio * rail.saturation_limit_rad_s + 4.0 * std::sqrt(rail.covariance(3, 3));
}

std::array<SaturationPlaneFinder, 2> plane_finders_by_stated_range(SaturationPlaneFinder::Params params,
                                                                   const std::optional<double>& stated) {
  SaturationPlaneFinder::Params unstated = params;
  unstated.stated_range_rad_s = std::nullopt;
  if (!params.stated_range_rad_s) params.stated_range_rad_s = stated;
  return {SaturationPlaneFinder(params), SaturationPlaneFinder(unstated)};
}

}  // namespace

std::array<std::array<SaturationPlaneFinder, 2>, 2> make_plane_finders(const ClippingFinder::Params& params) {
  return {
      plane_finders_by_stated_range(params.gyro_planes, params.axis_limit_params.stated_gyro_range_rad_s),
      plane_finders_by_stated_range(params.accel_saturation_planes, params.axis_limit_params.stated_accel_range_m_s2)};
}

bool stated_range_contradicted(const SaturationLimitDetector& axis_aligned_rails,
                               const SaturationLimitDetector::State& state, Triad triad) {
  const int first = static_cast<int>(first_channel(triad));
  return axis_aligned_rails.disagrees(state, first) || axis_aligned_rails.disagrees(state, first + 1) ||
         axis_aligned_rails.disagrees(state, first + 2);
}

bool are_upright(std::span<const Eigen::Vector3d> readings, const SaturationPlanes& planes,
                 const SaturationLimitDetector::State& rails, Triad triad) {
  int nil = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& rail = planes.sensing_axis[j];
    const double plateau = rails.channels[first_channel(triad) + j].plateau_limit;
    if (rail && has_unequal_limits(*rail)) return false;
    if (rail && plateau > 0.0) {
      // If the device compensates misalignment after clipping, each clipped output also depends on the rates about the
      // other axes, so most clipped readings of an axis differ.
      const auto equal = std::count_if(readings.begin(), readings.end(), [&](const Eigen::Vector3d& y) {
        return std::abs(std::abs(y[static_cast<Eigen::Index>(j)]) - plateau) <= kEqualReadingsRatio * plateau;
      });
      if (2 * equal >= rail->samples[0] + rail->samples[1]) {
        nil += 2;
        continue;
      }
    }
    if (!rail) {
      nil += plateau > 0.0 ? 1 : 0;
      continue;
    }
    for (int i = 0; i < 2; ++i) {
      const double slope = rail->row[static_cast<Eigen::Index>((j + 1 + static_cast<std::size_t>(i)) % 3)];
      const double sigma = std::sqrt(rail->covariance(i, i));
      if (std::abs(slope) > kNegligibleSlope + 4.0 * sigma) return false;
      nil += sigma < kDeterminedSlopeSigma ? 1 : 0;
    }
  }
  return nil >= 2;
}

SaturationPlanes without_planes_from_plateaus(const SaturationPlanes& planes,
                                              const SaturationLimitDetector::State& rails, Triad triad) {
  SaturationPlanes out = planes;
  for (std::size_t j = 0; j < 3; ++j) {
    if (rails.channels[first_channel(triad) + j].plateau_limit > 0.0) out.sensing_axis[j].reset();
  }
  return out;
}

Clipping clipping_from_planes(const SaturationPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                              const ImuSample* before, const ImuSample& now, const ImuSample* after) {
  Clipping out = by_axis_aligned_rails;
  std::uint8_t& bits = triad == Triad::gyro ? out.gyro : out.accel;
  const std::uint8_t unreadable = triad == Triad::gyro ? by_axis_aligned_rails.unusable_gyro : 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& rail = planes.sensing_axis[j];
    if (!rail || (unreadable >> j & 1u) != 0) continue;
    const int sign = half_range_side(now, triad, j);
    const auto beside = [&](const ImuSample* sample, const ImuSample* outside) {
      return sample != nullptr && half_range_side(*sample, triad, j) == sign &&
             is_at_saturation_limit(*sample, triad, *rail, j) && reaches_limit(*rail, triad, now, outside, sign);
    };
    const bool clipped = is_at_saturation_limit(now, triad, *rail, j) || beside(after, before) || beside(before, after);
    const auto bit = static_cast<std::uint8_t>(1u << j);
    bits = static_cast<std::uint8_t>(clipped ? bits | bit : bits & ~bit);
  }
  return out;
}

void mark_partial_saturation(const SaturationPlanes& planes, const SaturationLimitDetector& rails,
                             const SaturationLimitDetector::State& state, double noise_rad_s, const ImuSample* before,
                             AngularRateObservation& now, const ImuSample* after) {
  mark_partial_saturation(rails, state, noise_rad_s, before, now, after);
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& rail = planes.sensing_axis[j];
    const bool flagged = (now.sample.device_clip_flags >> j & 1u) != 0 && (now.clipping.unusable_gyro >> j & 1u) == 0;
    if (!rail || !flagged) continue;
    const auto bit = static_cast<std::uint8_t>(1u << j);
    now.partial_saturation_flags = static_cast<std::uint8_t>(now.partial_saturation_flags & ~bit);
    const int sign = half_range_side(now.sample, Triad::gyro, j);
    const double level = rail->saturation_limit_rad_s;
    const double reading = level - rail->distance_to_plane_rad_s(now.sample.angular_velocity_rad_s, sign);
    const double neighbour = unsaturated_neighbour_reading(
        reading, level, static_cast<int>(j), before, after,
        [&](const Eigen::Vector3d& beside) { return level - rail->distance_to_plane_rad_s(beside, sign); });
    if (level - reading <= rail->tolerance_rad_s || neighbour > reading) continue;
    const PartialSaturation loss = partial_saturation(reading, neighbour, level, noise_rad_s);
    if (!loss.saturated) continue;
    now.partial_saturation_flags = static_cast<std::uint8_t>(now.partial_saturation_flags | bit);
    now.expected_saturation_deficit_rad_s[static_cast<Eigen::Index>(j)] = sign * loss.expected_saturation_deficit_rad_s;
    now.saturation_deficit_sigma_rad_s[static_cast<Eigen::Index>(j)] = loss.sigma_rad_s;
  }
}

// See rails.md (R59).
std::optional<EstimatedCrossAxisSlopes> estimated_slopes(const SaturationPlanes& planes, bool upright, int element,
                                                         const Eigen::Matrix2d& before) {
  if (upright) {
    return EstimatedCrossAxisSlopes{Eigen::Vector2d::Zero(),
                                    kUprightSigma * kUprightSigma * Eigen::Matrix2d::Identity()};
  }
  const auto& rail = planes.sensing_axis[static_cast<std::size_t>(element)];
  if (!rail) return std::nullopt;
  const Eigen::Matrix2d estimated =
      rail->covariance.topLeftCorner<2, 2>() + kSlopeSigmaMin * kSlopeSigmaMin * Eigen::Matrix2d::Identity();
  if (estimated.trace() >= before.trace()) return std::nullopt;
  return EstimatedCrossAxisSlopes{{rail->row[(element + 1) % 3], rail->row[(element + 2) % 3]}, estimated};
}

BodyImuCalibration calibration_prior_from_planes(const AngularRateModel& before, const SaturationPlanes& planes,
                                                 bool upright) {
  BodyImuCalibration out{before.prior_constants(), before.prior_covariance()};
  for (int j = 0; j < 3; ++j) {
    const Eigen::Index first = BodyImuConstants::kGyroMisalignmentIndex + 2 * j;
    const auto estimated = estimated_slopes(planes, upright, j, out.covariance.block<2, 2>(first, first));
    if (!estimated) continue;
    out.constants.gyro_misalignment.segment<2>(first - BodyImuConstants::kGyroMisalignmentIndex) =
        estimated->cross_axis_slopes;
    out.covariance.middleRows<2>(first).setZero();
    out.covariance.middleCols<2>(first).setZero();
    out.covariance.block<2, 2>(first, first) = estimated->covariance;
  }
  return out;
}

}  // namespace tumble
