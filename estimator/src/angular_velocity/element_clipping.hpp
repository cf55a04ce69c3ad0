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

/// Place of a triad in arrays, and of its first channel in those of RailDetector and among ClipFlag bits.
inline std::size_t index_of(Triad triad) {
  return triad == Triad::gyro ? 0 : 1;
}
inline std::size_t first_channel(Triad triad) {
  return 3 * index_of(triad);
}

/// The searches for planes of gyro and accelerometer: with the stated range of the upright rails, and without any.
std::array<std::array<RailPlaneFinder, 2>, 2> plane_finders(const ClippingFinder::Params& params);

/// A stated range that the readings contradict tells the planes nothing.
bool stated_range_contradicted(const RailDetector& upright_rails, const RailDetector::State& state, Triad triad);

/// Whether the rails found, and the plateaus of equal readings, show a device that clips what it delivers: rails
/// upright, nothing hidden on the axes beside. Two slopes known to be nil tell, a plateau counting for one; one that is
/// not nil tells the contrary.
bool are_upright(std::span<const Eigen::Vector3d> readings, const RailPlanes& planes, const RailDetector::State& rails,
                 Triad triad);

/// The planes of elements on whose axis no plateau of equal readings was seen.
RailPlanes without_plateaus(const RailPlanes& planes, const RailDetector::State& rails, Triad triad);

/// Brings the planes of a triad into what was classified with upright rails: an element with a plane clips where its
/// plane says so or the device does. A sample that met a rail in a part of its window, beside one that is clipped,
/// belongs to it: it lies short of the plane by less than half of what the neighbour outside still lacked. `before`,
/// `after`: null where there is none.
Clipping clip_by_planes(const RailPlanes& planes, Triad triad, const Clipping& by_upright_rails,
                        const ImuSample* before, const ImuSample& now, const ImuSample* after);

/// Finds such axes as mark_subsample_saturation() does, with the rail of each element where its plane is known.
void mark_subsample_saturation(const RailPlanes& planes, const RailDetector& rails, const RailDetector::State& state,
                               double noise_rad_s, const ImuSample* before, RateObservation& now,
                               const ImuSample* after);

/// What rails tell of the slopes of an element, in the order of RigConstants::elements.
struct ToldSlopes {
  Eigen::Vector2d slopes;
  Eigen::Matrix2d covariance;
};
/// Nothing where that is no more than was known: `before`.
std::optional<ToldSlopes> told_slopes(const RailPlanes& planes, bool upright, int element,
                                      const Eigen::Matrix2d& before);

/// What was known of the rig with what the planes tell of RigConstants::elements.
RigCalibration with_planes(const RateModel& before, const RailPlanes& planes, bool upright);

}  // namespace tumble
