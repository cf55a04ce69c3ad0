// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Resamples the readings of several IMUs, each with its own time stamps, to common times.
///
/// The common times are the stamps of one unit, the reference: the first unit, until it has no reading for kSilentMax_s
/// while another unit has. The next unit with readings is then the reference. The readings of the other units are
/// interpolated linearly (ImuInterpolation). A unit without a reading within kSilentMax_s before and after a common
/// time is absent at that time. The alignment is causal: a common time is complete once each unit has a later reading
/// or is silent for kSilentMax_s, so the output is at most kSilentMax_s late.
///
/// Cost: O(1) per reading. The stored readings cover kSilentMax_s; storage grows until then.
class UnitAlignment {
 public:
  static constexpr double kSilentMax_s = 0.05;
  using Readings = std::array<ImuSample, ImuMerge::kImus>;

  struct State {
    /// Readings of each unit from the last one before the newest common time on.
    std::array<std::vector<ImuSample>, ImuMerge::kImus> readings;
    std::size_t reference = 0;
    std::optional<TimeNs> first_ns;   ///< first reading of any unit
    std::optional<TimeNs> common_ns;  ///< newest common time
  };

  /// Constructs for `units` units, at most ImuMerge::kImus.
  explicit UnitAlignment(std::size_t units) : units_(units) {}

  /// Adds a reading of one unit. A reading that is not finite is ignored. Returns `time_order` if the stamp is not
  /// later than the unit's last stamp; the state is then unchanged.
  Status push(std::size_t unit, const ImuSample& sample, State& state) const;

  /// Writes the readings at the next common time to `out`, all with that time; the rates of an absent unit are NaN.
  /// Returns false if the next common time is not complete yet. `ended` states that no further readings follow.
  bool next(State& state, Readings& out, bool ended = false) const;

 private:
  void choose_reference(State& state) const;
  bool is_complete(std::size_t unit, TimeNs time_ns, const State& state) const;

  std::size_t units_;
};

}  // namespace tumble
