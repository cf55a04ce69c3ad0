// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

struct ClippedReadings {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();  ///< sensing directions of the gyro, one per row
  std::vector<ClipSigns> signs;                        ///< one entry per sample
  std::vector<std::uint8_t> near;  ///< per sample: bit j is set if gyro element j may be partly saturated

  ClippedElements clipped() const { return {rows, signs}; }

  /// Marks suspect gyro readings, which may be saturated at an unknown limit, as lower bounds of the rate. Bit j of
  /// `axes[k]` is set if the reading of gyro axis j in sample k is suspect.
  void mark_suspect(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// Sets the source of a measured rate to `bounded_only` if the gyro reading may be saturated during a part of its
  /// averaging window. `rates` contains one rate per sample.
  void mark_partly_saturated(std::span<RateState> rates) const;
};

/// Cost: O(N).
ClippedReadings to_clipped_readings(std::span<const ImuSample> samples, const ClippingFinder::Found& found);

}  // namespace tumble
