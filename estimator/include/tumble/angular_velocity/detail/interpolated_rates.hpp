// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_stream_state.hpp"
#include "tumble/common/types.hpp"

/// Cubic interpolation between the readings of a gyro that updates more slowly than the log, so that the log repeats
/// readings: rate_stream.md (R96).
namespace tumble {

/// Rate between two readings of the gyro, including the gyro bias.
struct InterpolatedRate {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  /// variance of the interpolation error, excluding sensor noise
  Eigen::Vector3d variance_rad2_s2 = Eigen::Vector3d::Zero();
};

/// Returns the interpolated rate at sample `k` in the window of an AngularRateStream. The result is empty if no reading
/// repeats, the next reading has not yet arrived, or a reading is invalid. Cost: O(samples of three readings).
std::optional<InterpolatedRate> rate_between_readings(std::span<const AngularRateStreamKnot> window, std::size_t k,
                                                      double period_s);

/// Returns the interpolated rates of a recording, or an empty result if no reading repeats. `hidden` contains one bit
/// mask of unusable axes per sample; rates that need an unusable reading are empty. Cost: O(N).
std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden);
struct RepeatedReadings;
/// `repeated` is the result of find_repeated() for the gyro.
std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden,
                                                                    const std::optional<RepeatedReadings>& repeated);

/// Returns the interpolated specific force at each sample, for an accelerometer that updates more slowly than the log.
/// The result is empty if no reading repeats. Cost: O(N).
std::vector<Eigen::Vector3d> interpolated_forces(std::span<const ImuSample> samples);

}  // namespace tumble
