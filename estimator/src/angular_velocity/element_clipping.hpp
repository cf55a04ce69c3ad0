// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"

namespace tumble {

/// Returns the array index of a triad (gyro or accelerometer). first_channel() returns a different index, which is
/// three times as large: the triad's first channel in RailDetector and in ClipFlag bits.
inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// Returns finders of saturation planes for gyro and accelerometer, each with and without the stated range.
std::array<std::array<RailPlaneFinder, 2>, 2> plane_finders(const ClippingFinder::Params& params);

/// Returns whether the readings contradict the stated range; RailPlaneFinder then ignores the range.
bool stated_range_contradicted(const RailDetector& axis_aligned_rails, const RailDetector::State& state, Triad triad);

/// Returns whether the device clips each output axis separately, according to saturation planes and plateaus of equal
/// readings. Two cross-axis sensitivities that are known to be zero prove axis-wise clipping; a plateau counts as one
/// sensitivity. One non-zero cross-axis sensitivity proves the opposite.
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// Returns the saturation planes of those sensing elements whose axis has no plateau of equal readings.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Classifies samples as clipped by saturation planes, in addition to the classification by equal readings. A sensing
/// element with a known saturation plane is clipped according to the plane or the device's flag. The sample next to a
/// clipped sample also counts as clipped if the sensing element was saturated for a part of its window. A sample was
/// partly saturated if it is less than half as far from the plane as the next sample. `before` and `after` are the
/// neighbouring samples, or null.
Clipping classify_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                            const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Finds partly saturated axes, and uses the saturation plane of each sensing element whose plane is known.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

/// EstimatedSlopes contains what saturation planes reveal about the cross-axis sensitivities of one sensing element.
struct EstimatedSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedSlopes> estimated_slopes(const RailPlanes& planes, bool upright, int element,
                                                const Eigen::Matrix2d& before);

/// Returns the prior calibration after an update of RigConstants::elements by the saturation planes.
RigCalibration prior_with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
