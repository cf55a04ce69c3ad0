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

/// What is known of the rails in each sample of a recording, as CarriedSmoother wants it: flags of the device, plateaus
/// and tilted planes found in the readings.
struct CarriedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();  ///< of the gyro's planes, the axes where none was seen
  std::vector<ClipSigns> signs;                        ///< one per sample
  std::vector<std::uint8_t> near;                      ///< one per sample: bits of may_meet_rails()

  ClippedElements clipped() const { return {rows, signs}; }

  /// Free readings of these axes (bit j of each sample) may stand at a rail that was not seen: they are bounds.
  void doubt(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// A rate whose reading may have met its rail in a part of its window is bounded, not measured. `rates`: one per
  /// sample.
  void mark_near(std::span<RateState> rates) const;
};

/// Of samples that were judged. O(N).
CarriedElements carried_elements(std::span<const ImuSample> samples, const ClippingFinder::Found& found);

}  // namespace tumble
