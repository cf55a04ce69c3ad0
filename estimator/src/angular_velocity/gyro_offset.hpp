// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates a large zero offset of a gyro from the rest at the start of a run. The zero offset of a consumer gyro may
/// exceed 0.05 rad/s, the default limit of RestDetector for the mean rate at rest. GyroOffset mistakes a steady
/// rotation about the vertical for an offset.
class GyroOffset {
 public:
  static constexpr double kOffsetMin_rad_s = 0.05, kOffsetMax_rad_s = 0.15;
  static constexpr double kInitialRestLatestEnd_s = 2.0;  ///< latest end of the initial rest, after the first sample

  struct State {
    RestDetector::State stationary_state;
    std::optional<TimeNs> first_ns;
    bool offset_decided = false;
  };

  GyroOffset();

  /// Returns the gyro's zero offset for the sample at which the initial rest is detected, if the offset is large, and
  /// nothing otherwise. The sample must be finite. Cost: O(1), no allocation.
  std::optional<Eigen::Vector3d> detect_initial_offset(const ImuSample& sample, State& state) const;
  /// Returns the gyro's zero offset in a recording, or zero if the offset is small.
  Eigen::Vector3d find(std::span<const ImuSample> samples) const;

 private:
  RestDetector rest_detector_;
};

}  // namespace tumble
