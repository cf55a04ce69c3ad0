// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble {

/// Detects the saturation levels of several IMUs (units) on one body from their readings, causally. UnitRails flags
/// readings that a device clips without reporting saturation, before ImuMerge processes the readings. Each unit has a
/// StreamingClippingFinder with the rule of ConfirmedSaturation. ClippingFinder applies the rule of ConfirmedSaturation
/// to whole recordings.
///
/// A sample is classified by the saturation levels that earlier samples revealed. The first two to ten samples at a
/// saturation level are therefore not flagged. UnitRails does not report sensing directions of the units to ImuMerge.
class UnitRails {
 public:
  /// State of one unit.
  struct Unit {
    StreamingClippingFinder::State rails;
    std::optional<ImuSample> before;  ///< last finite sample
  };
  using State = std::array<Unit, ImuMerge::kImus>;
  using Samples = std::array<ImuSample, ImuMerge::kImus>;

  /// Constructs from the data sheets of the units, at most ImuMerge::kImus. Throws InvalidParams if a stated range is
  /// out of bounds.
  explicit UnitRails(std::span<const ImuSheet> sheets);

  /// Returns the state before the first samples, with all memory that observe() needs: 110 KiB per unit.
  State start() const;

  /// Copies `samples`, one per unit, to `out` and sets the flags of saturated axes. The function does not allocate.
  /// Samples that are not finite are copied unchanged.
  void flag_clipped(std::span<const ImuSample> samples, const State& state, Samples& out) const;

  /// Updates the state with raw samples. Cost: O(1), sometimes a search; no allocation.
  void observe(std::span<const ImuSample> samples, State& state) const;

  /// Checks the invariants of a state that was loaded from a file. Returns the first violated invariant.
  Status check_state(const State& state) const;

 private:
  struct UnitDetector {
    StreamingClippingFinder watch;
    ImuSheet sheet;
  };
  std::vector<UnitDetector> units_;
};

}  // namespace tumble
