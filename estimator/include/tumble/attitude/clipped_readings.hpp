// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/hand_held_smoother.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// ClippedReadings contains the clipped sensing elements of each sample of a recording, as input of HandHeldSmoother.
struct ClippedReadings {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();  ///< sensing directions of the gyro, one per row
  std::vector<ClipSigns> signs;                        ///< one entry per sample
  std::vector<std::uint8_t> near;                      ///< one entry per sample: bits of possible_partial_saturation()

  ClippedElements clipped() const { return {rows, signs}; }

  /// Treats gyro readings that may be saturated at an unknown limit as lower bounds instead of measurements. The
  /// argument `axes` contains one byte per sample; bit j is set if the reading of axis j may be saturated.
  void mark_suspect(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// Marks an estimated rate as a lower bound if its reading may have been saturated during a part of the averaging
  /// window. The argument `rates` contains one rate per sample.
  void mark_partly_saturated(std::span<RateState> rates) const;
};

/// Converts the result of a ClippingFinder to the input of HandHeldSmoother. Cost: O(N).
ClippedReadings to_clipped_readings(std::span<const ImuSample> samples, const ClippingFinder::Found& found);

}  // namespace tumble
