// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rail_detector.hpp"
#include "tumble/angular_velocity/detail/rail_planes.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// Returns a RailPlaneFinder for gyro and accelerometer, each with and without the data sheet's range.
std::array<std::array<RailPlaneFinder, 2>, 2> plane_finders(const ClippingFinder::Params& params);

bool stated_range_contradicted(const RailDetector& axis_aligned_rails, const RailDetector::State& state, Triad triad);

/// Returns whether the device clips each output axis separately (upright rails).
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// Removes the planes of axes on which several successive extreme readings are equal.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Marks a sample as clipped if its reading is at or beyond a saturation limit of `planes`, or if the device flags the
/// sample.
Clipping classify_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                            const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Marks axes that are saturated for a part of the sample's averaging window.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

struct EstimatedSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedSlopes> estimated_slopes(const RailPlanes& planes, bool upright, int element,
                                                const Eigen::Matrix2d& before);

RigCalibration prior_with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
