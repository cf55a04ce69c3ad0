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

/// Returns 0 for the gyro and 1 for the accelerometer. first_channel() returns another index: the sensor's first
/// channel in RailDetector and in the bits of ClipFlag.
inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// Returns finders of saturation planes for gyro and accelerometer. Each sensor has one finder that uses the data
/// sheet's range and one that does not.
std::array<std::array<RailPlaneFinder, 2>, 2> plane_finders(const ClippingFinder::Params& params);

/// Returns whether the readings contradict the range of the data sheet. RailPlaneFinder ignores a contradicted range.
bool stated_range_contradicted(const RailDetector& axis_aligned_rails, const RailDetector::State& state, Triad triad);

/// Returns whether the device clips each output axis separately (upright rails). The proof needs two cross-axis
/// sensitivities that are known to be zero; a run of equal readings counts as one. A single non-zero cross-axis
/// sensitivity excludes axis-wise clipping.
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// Returns `planes` without the saturation planes of axes that have a run of equal extreme readings.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Classifies samples as clipped by saturation planes, in addition to the classification by equal readings. A sensing
/// element with a known saturation plane is clipped if its reading is on the plane or flagged by the device. A sample
/// next to a clipped sample also counts as clipped if it was saturated for a part of its averaging window. A sample was
/// partly saturated if: distance from the plane < half of the step to its other neighbour. `before` and `after` are the
/// neighbouring samples, or null.
Clipping classify_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                            const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Finds the axes that are saturated for a part of the sample's averaging window. Known saturation planes replace
/// axis-aligned saturation levels.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

/// EstimatedSlopes contains one sensing element's cross-axis sensitivities, computed from the saturation planes.
struct EstimatedSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedSlopes> estimated_slopes(const RailPlanes& planes, bool upright, int element,
                                                const Eigen::Matrix2d& before);

/// Returns the prior calibration with the cross-axis sensitivities (RigConstants::elements) that the saturation planes
/// determine.
RigCalibration prior_with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
