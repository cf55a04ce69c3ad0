// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates a gyro's zero offset from the rest at the start of a run, if the offset is larger than the mean rate that
/// RestDetector accepts at rest by default (0.05 rad/s). Data sheets of consumer gyros allow such offsets. At rest,
/// rate and force are constant for half a second, and the offset is at most kOffsetMax_rad_s per axis. A smaller offset
/// needs no estimate: the prior of the bias includes it. GyroOffset does not distinguish an offset from a steady
/// rotation about the vertical.
class GyroOffset {
 public:
  static constexpr double kOffsetMin_rad_s = 0.05, kOffsetMax_rad_s = 0.15;
  static constexpr double kRestEndMax_s = 2.0;  ///< the rest must end within this time after the first sample

  struct State {
    RestDetector::State rest;
    std::optional<TimeNs> first_ns;  ///< time of the first sample
    bool decided = false;
  };

  GyroOffset();

  /// Processes a finite sample. Returns the offset once, as soon as it is known. O(1), no allocation.
  std::optional<Eigen::Vector3d> observe(const ImuSample& sample, State& state) const;
  /// Returns the offset of a recording, or zero without a large offset.
  Eigen::Vector3d find(std::span<const ImuSample> samples) const;

 private:
  RestDetector rest_detector_;
};

}  // namespace tumble
