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

/// Rates of a gyro that is slower than its log, whose readings are said again and tell of what was: cubic between the
/// readings about a sample, each at the time of which it tells. docs/maths/rate_stream.md (R100).
namespace tumble {

/// A rate between two readings of the gyro, its bias included.
struct HeldRate {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_rad2_s2 = Eigen::Vector3d::Zero();  ///< of each axis, beyond the readings' noise
};

/// That of sample `k` of a stream's window. Nothing where the log has a reading for each sample, before the reading
/// after it has come, and where one of the two is not wholly read. O(samples of three readings).
std::optional<HeldRate> rate_between_readings(std::span<const RateStreamKnot> window, std::size_t k, double period_s);

/// Those of a recording; empty where the log has a reading for each sample. Axes of `hidden` are not read, one mask per
/// sample: nothing beside such a reading, nor at the ends. O(N), and find_held.
std::vector<std::optional<HeldRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                            std::span<const std::uint8_t> hidden);
struct HeldReadings;
/// The same, where find_held was asked of the gyro before, and what it said.
std::vector<std::optional<HeldRate>> rates_between_readings(std::span<const ImuSample> samples,
                                                            std::span<const std::uint8_t> hidden,
                                                            const std::optional<HeldReadings>& held);

/// What an accelerometer that is slower than its log says of each sample's own time: between two readings along the
/// line from one to the other, as said before the first and after the last. Empty where the log has a reading for each
/// sample. O(N), and find_held.
std::vector<Eigen::Vector3d> forces_between_readings(std::span<const ImuSample> samples);

}  // namespace tumble
