// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct ClippedReadings {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();  ///< of the gyro, one per row
  std::vector<ClipSigns> clip_signs;
  std::vector<std::uint8_t> possibly_clipped_axes;  ///< bit j: gyro element j may be partly saturated

  SensingAxisClipSigns clipped_element_signs() const { return {sensing_directions, clip_signs}; }

  /// Marks gyro readings that may be saturated at an unknown limit as lower bounds of the rate. Bit j of `axes[k]`
  /// marks gyro axis j in sample k.
  void mark_suspected_saturation(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// Changes the source of a rate from `measured` to `lower_bound_only` if the gyro may be saturated during a part of
  /// the averaging window. `rates` contains one rate per sample.
  void mark_partly_saturated(std::span<AngularRateState> rates) const;
};

/// Cost: O(N).
ClippedReadings clipped_readings_of(std::span<const ImuSample> samples,
                                    const ClippingFinder::ClippingSearchResult& found);

}  // namespace tumble
