// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "tumble/mapping/detail/odometer_reading.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble {

/// A sweep that waits for the rates of its samples.
struct WaitingSweep {
  TimeNs start_ns = 0, end_ns = 0;
  std::vector<LidarPoint> points;
};

/// Readings of an odometer that wait for the sweep that they are of, which ends later than they come. Copies carry all
/// state.
class WaitingReadings {
 public:
  /// So many wait at most: of 500 Hz what a lidar may be silent for and a lag of a second.
  static constexpr std::size_t kMost = 1024;
  /// By how much a reading may reach beyond the sweep: clocks differ.
  static constexpr auto kBeyond_ns = static_cast<TimeNs>(1e9 * SweepTrajectory::kBeyond_s);

  /// Takes a reading in, in any order, from after `done_ns`, up to which sweeps have been registered, to `latest_ns`.
  /// Trouble: that of check_reading, `time_order` (its sweep is gone), `out_of_range` (it is of later, too many wait).
  Status add(const OdometerReading& reading, TimeNs done_ns, TimeNs latest_ns);

  /// The reading of the sweep from `from_ns` to `end_ns`, the last one where there are several: their errors hang
  /// together. Those of that time and before are forgotten.
  std::optional<OdometerReading> take(TimeNs from_ns, TimeNs end_ns);

  /// Those that were of no sweep: they reach from one into the next.
  std::size_t straddling() const { return straddling_; }

  /// Visits every member of the state. Defined in the library's sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  std::deque<OdometerReading> waiting_;  ///< in order of their middles
  std::size_t straddling_ = 0;
};

}  // namespace tumble
