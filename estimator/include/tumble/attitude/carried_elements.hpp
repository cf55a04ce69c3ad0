// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/carried_smoother.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Clipped sensing elements of each sample of a recording, as input of CarriedSmoother. Clipping is found from flags of
/// the device, and from plateaus and tilted planes in the readings.
struct CarriedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();  ///< sensing directions of the gyro; axes without planes
  std::vector<ClipSigns> signs;                        ///< one per sample
  std::vector<std::uint8_t> near;                      ///< one per sample: bits of may_meet_rails()

  ClippedElements clipped() const { return {rows, signs}; }

  /// Treats unclipped readings of the given axes (bit j of each sample) as lower bounds because the readings may be at
  /// an unknown saturation level.
  void mark_suspect(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// Marks a rate as bounded instead of measured if its reading may have been saturated for a part of the reading's
  /// window. `rates` has one entry per sample.
  void mark_near(std::span<RateState> rates) const;
};

/// Converts the result of a ClippingFinder. O(N).
CarriedElements carried_elements(std::span<const ImuSample> samples, const ClippingFinder::Found& found);

}  // namespace tumble
