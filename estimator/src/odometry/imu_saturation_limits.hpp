// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

/// Detects the saturation limits of several IMUs on one body from their readings, causally. Only confirmed saturation
/// limits count, as defined by ConfirmedSaturation.
///
/// ImuSaturationLimits detects a saturation limit from the first two to ten samples at the limit, which are not
/// flagged.
class ImuSaturationLimits {
 public:
  struct ImuClippingState {
    StreamingClippingFinder::State clipping_state;
    std::optional<ImuSample> previous_sample;  ///< last finite sample
  };
  using State = std::array<ImuClippingState, ImuMerge::kImus>;
  using Samples = std::array<ImuSample, ImuMerge::kImus>;

  /// At most ImuMerge::kImus data sheets. Throws InvalidParams if a stated range is out of bounds.
  explicit ImuSaturationLimits(std::span<const ImuDataSheet> sheets);

  /// Sets the saturation limits and the saturation planes (SaturationPlane) of an IMU to the results of an earlier run.
  void start_from_saturation_levels(std::size_t unit, const SaturationLevels& rails);

  /// Returns the state before the first samples, with all memory that observe_readings() needs: 110 KiB per IMU.
  State start() const;

  /// Copies `samples` (one per IMU) to `out` and flags saturated axes, without allocating memory. Samples that are not
  /// finite are copied unchanged.
  void flag_clipped(std::span<const ImuSample> samples, const State& state, Samples& out) const;

  /// The samples must be unflagged. Cost: O(1), except for rare searches for saturation planes (SaturationPlane). No
  /// memory is allocated.
  void observe_readings(std::span<const ImuSample> samples, State& state) const;

 private:
  struct ImuClippingFinder {
    StreamingClippingFinder clipping_finder;
    ImuDataSheet data_sheet;
  };
  std::vector<ImuClippingFinder> imus_;
};

}  // namespace tumble
