// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

/// Detects the saturation limits of several IMUs on one body from their readings, causally. UnitRails flags readings
/// that a device clips without reporting saturation, before ImuMerge processes the readings. UnitRails uses only
/// confirmed saturation limits, as defined by ConfirmedSaturation.
///
/// UnitRails classifies a sample by the saturation limits that earlier samples revealed. The first two to ten samples
/// at a saturation limit are therefore not flagged.
class UnitRails {
 public:
  /// Unit contains the detection state of one IMU.
  struct Unit {
    StreamingClippingFinder::State rails;
    std::optional<ImuSample> before;  ///< last finite sample
  };
  using State = std::array<Unit, ImuMerge::kImus>;
  using Samples = std::array<ImuSample, ImuMerge::kImus>;

  /// Constructs from the data sheets of the IMUs, at most ImuMerge::kImus. Throws InvalidParams if a stated range is
  /// out of bounds.
  explicit UnitRails(std::span<const ImuSheet> sheets);

  /// Sets the saturation limits and planes of an IMU as known from an earlier run.
  void start_from(std::size_t unit, const SaturationLevels& rails);

  /// Returns the state before the first samples, with all memory that observe() needs: 110 KiB per IMU.
  State start() const;

  /// Copies `samples`, one per IMU, to `out` and sets the flags of saturated axes, without allocating memory. The
  /// function copies samples that are not finite unchanged.
  void flag_clipped(std::span<const ImuSample> samples, const State& state, Samples& out) const;

  /// Updates the state with unflagged samples. Cost: O(1), sometimes a search; no allocation.
  void observe(std::span<const ImuSample> samples, State& state) const;

 private:
  struct UnitDetector {
    StreamingClippingFinder watch;
    ImuSheet sheet;
  };
  std::vector<UnitDetector> units_;
};

}  // namespace tumble
