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

/// Returns the array index of the gyro or accelerometer. The function first_channel() returns another index: the
/// sensor's first channel in RailDetector and in the bits of ClipFlag.
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

/// Returns whether the saturation planes and runs of equal readings show that the device clips each output axis
/// separately. Axis-wise clipping is proven if two cross-axis sensitivities are known to be zero; a run of equal
/// readings counts as one. A single non-zero cross-axis sensitivity excludes axis-wise clipping.
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// Returns the saturation planes of all sensing elements except those whose axis has a run of equal extreme readings.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Classifies samples as clipped by saturation planes, in addition to the classification by equal readings. A sensing
/// element with a known saturation plane is clipped if its reading is on the plane or flagged by the device. The sample
/// next to a clipped sample also counts as clipped if the sensing element was saturated for a part of its window. A
/// sample was partly saturated if its distance from the plane is less than half of the next sample's distance. `before`
/// and `after` are the neighbouring samples, or null.
Clipping classify_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                            const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Finds the axes that are saturated for a part of the sample, from saturation planes where a plane is known.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

/// EstimatedSlopes contains the cross-axis sensitivities of one sensing element that follow from the saturation planes.
struct EstimatedSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedSlopes> estimated_slopes(const RailPlanes& planes, bool upright, int element,
                                                const Eigen::Matrix2d& before);

/// Returns the prior calibration after the saturation planes have updated its cross-axis sensitivities
/// (RigConstants::elements).
RigCalibration prior_with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
