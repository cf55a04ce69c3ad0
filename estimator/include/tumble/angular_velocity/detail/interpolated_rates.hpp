// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_stream_state.hpp"
#include "tumble/common/imu.hpp"

/// Interpolation for a gyro that is slower than its log, so that readings are repeated and refer to an earlier time.
/// The interpolation is cubic between the readings around a sample, each at its true time. docs/maths/rate_stream.md
/// (R96).
namespace tumble {

/// A rate between two readings of the gyro, including its bias.
struct InterpolatedRate {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_rad2_s2 = Eigen::Vector3d::Zero();  ///< variance of the interpolation, without noise
};

/// Returns the rate of sample `k` of a stream's window. The result is empty in three cases: each sample has its own
/// reading, the next reading has not yet arrived, or one of the two readings is not fully usable. O(samples of three
/// readings).
std::optional<InterpolatedRate> rate_between_readings(std::span<const RateStreamKnot> window, std::size_t k,
                                                      double period_s);

/// Returns the rates of a recording. The list is empty if each sample has its own reading. Axes in `hidden` (one mask
/// per sample) are not used, so no rate is computed next to hidden axes or at the ends. O(N), plus find_repeated.
std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden);
struct RepeatedReadings;
/// Returns the rates of a recording from an earlier result of find_repeated for the gyro.
std::vector<std::optional<InterpolatedRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                                    std::span<const std::uint8_t> hidden,
                                                                    const std::optional<RepeatedReadings>& repeated);

/// Returns the force at the time of each sample, for an accelerometer that is slower than its log. The force is linear
/// between readings, constant before the first reading and after the last. The list is empty if each sample has its own
/// reading. O(N), plus find_repeated.
std::vector<Eigen::Vector3d> forces_between_readings(std::span<const ImuSample> samples);

}  // namespace tumble
