// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rail_watch.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble {

/// The rails of the IMUs of one body, as their readings show them while they come: what a device clips without saying
/// so is flagged before ImuMerge is given it. RailWatch for each unit, by the rule of HeardRails, as it is told of a
/// whole recording by ClippingFinder.
///
/// A sample is judged by what those before it showed. Not modelled: the samples by which a rail shows itself, some two
/// to ten; they were believed. Along what the elements of a unit sense ImuMerge is not told either.
class UnitRails {
 public:
  /// What is known of one unit.
  struct Unit {
    RailWatch::State rails;
    std::optional<ImuSample> before;  ///< its last finite sample
  };
  using State = std::array<Unit, ImuMerge::kImus>;
  using Samples = std::array<ImuSample, ImuMerge::kImus>;

  /// Of units with these sheets, at most ImuMerge::kImus. Throws InvalidParams on a stated range out of its bounds.
  explicit UnitRails(std::span<const ImuSheet> sheets);

  /// Before the first samples, with all memory that observe() needs: 110 KiB a unit.
  State start() const;

  /// `samples`, one of each unit, with what they hide flagged. What is not finite stays as it is. No allocation.
  void flag(std::span<const ImuSample> samples, const State& state, Samples& out) const;

  /// Learns from samples, as they were read. O(1), and a search now and then; no allocation.
  void observe(std::span<const ImuSample> samples, State& state) const;

  /// What holds of every state that observe() left, for one that comes from elsewhere; the first that does not.
  Status check_state(const State& state) const;

 private:
  struct Watched {
    RailWatch watch;
    ImuSheet sheet;
  };
  std::vector<Watched> units_;
};

}  // namespace tumble
