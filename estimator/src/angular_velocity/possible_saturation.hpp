// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// Returns four SaturationPlaneFinders, two for the gyro and two for the accelerometer. For each sensor, the first
/// SaturationPlaneFinder uses the range from the data sheet, and the second SaturationPlaneFinder ignores this range.
std::array<std::array<SaturationPlaneFinder, 2>, 2> make_plane_finders(const ClippingFinder::Params& params);

bool stated_range_contradicted(const SaturationLimitDetector& axis_aligned_rails,
                               const SaturationLimitDetector::State& state, Triad triad);

/// Returns whether the device clips each output axis separately, at fixed saturation limits.
bool are_upright(std::span<const Eigen::Vector3d> readings, const SaturationPlanes& planes,
                 const SaturationLimitDetector::State& rails, Triad triad);

/// Returns a copy of `planes` without the saturation planes (SaturationPlane) of axes that have a plateau. A plateau is
/// a sequence of equal extreme readings.
SaturationPlanes without_planes_from_plateaus(const SaturationPlanes& planes,
                                              const SaturationLimitDetector::State& rails, Triad triad);

/// Marks a sample as clipped if its reading is at or beyond a saturation limit of `planes`, or if the device flags the
/// sample.
Clipping clipping_from_planes(const SaturationPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                              const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Marks axes that are saturated for a part of the sample's averaging window.
void mark_partial_saturation(const SaturationPlanes& planes, const SaturationLimitDetector& rails,
                             const SaturationLimitDetector::State& state, double noise_rad_s, const ImuSample* before,
                             AngularRateObservation& now, const ImuSample* after);

struct EstimatedCrossAxisSlopes {
  Eigen::Vector2d cross_axis_slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedCrossAxisSlopes> estimated_slopes(const SaturationPlanes& planes, bool upright, int element,
                                                         const Eigen::Matrix2d& before);

BodyImuCalibration calibration_prior_from_planes(const AngularRateModel& before, const SaturationPlanes& planes,
                                                 bool upright);

/// Finds readings that may have been saturated for a part of their averaging window, see rails.md (R76). Cost: O(N).
std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples,
                                                      const SaturationPlanes& planes);

/// `before` and `after` are the readings immediately before and after `now`. At the start or end of a recording, the
/// missing reading is null.
std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const SaturationPlanes& planes);

/// If the saturation level of a sensing element is unknown, readings near the saturation levels of the other elements
/// are marked as possibly saturated. Readings below `least`, the smallest possible saturation level, remain unmarked.
void inflate_covariance_near_limits(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                                    const ImuSample* after);

/// Marks successive, almost equal maximum readings that may hide a saturated peak. No reading is marked if the device
/// flags clipping, or if no saturation level is known.
void inflate_covariance_at_plateaus(const SaturationPlanes& planes, const MinSaturationLevels& least,
                                    double offset_sigma_ratio, double noise_rad_s,
                                    std::span<AngularRateObservation> observations);

}  // namespace tumble
