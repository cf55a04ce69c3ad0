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

/// Returns the index of a triad (gyro or accelerometer) in arrays. The function first_channel() returns the index of
/// the triad's first channel in RailDetector and ClipFlag bits, which is three times as large.
inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// Returns the plane finders of gyro and accelerometer, each in two versions: with the stated range, and without any
/// range.
std::array<std::array<RailPlaneFinder, 2>, 2> plane_finders(const ClippingFinder::Params& params);

/// Returns whether readings contradict the stated range; RailPlaneFinder then ignores the stated range.
bool stated_range_contradicted(const RailDetector& axis_aligned_rails, const RailDetector::State& state, Triad triad);

/// Returns whether planes and plateaus of equal readings indicate a device that clips its output, so that other axes
/// are unaffected. Two cross-axis sensitivities that are known to be zero are sufficient; a plateau counts as one
/// sensitivity. A single non-zero cross-axis sensitivity is sufficient for the opposite result.
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// Returns the saturation planes of sensing elements on whose axis no plateau of equal readings was found.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Adds the saturation planes of a triad to a classification by equal readings. A sensing element with a known
/// saturation plane clips according to the plane or the device's flag. A neighbour of a clipped sample also counts as
/// clipped if the neighbour was saturated for a part of its window. A neighbour was partly saturated if its distance
/// from the plane is less than half of the distance of the next sample. `before` and `after` may be null.
Clipping classify_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_axis_aligned_rails,
                            const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Finds partly saturated axes like mark_subsample_saturation() of RateObservation, but uses the saturation level of
/// each element whose plane is known.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

/// EstimatedSlopes contains the information of saturation planes about the cross-axis sensitivities of a sensing
/// element, in the order of RigConstants::elements.
struct EstimatedSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
std::optional<EstimatedSlopes> estimated_slopes(const RailPlanes& planes, bool upright, int element,
                                                const Eigen::Matrix2d& before);

/// Returns the prior calibration, updated by the information of saturation planes about RigConstants::elements.
RigCalibration prior_with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
