// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>

#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Where the sensor stands to its map, and how a sweep changes that.
namespace tumble::mapping {

struct WaitingForStart {};

/// In the map. A sweep may find no place there and still pass, by a trusted prior or because the search was given up.
struct Tracking {
  int failed_searches = 0;  ///< sweeps in a row that had points and found no place
};

struct Lost {
  int sweeps = 1;  ///< rejected in a row
  int failed_searches = 0;
};

/// A search found a place that nothing has borne out yet: the motion by inertia goes on beside it (DeadReckoning), and
/// is gone back to where a sweep contradicts the place. mapping.md (R120), (R121).
struct FoundAgain {
  int after_sweeps = 0;  ///< that were lost
  int failed_searches = 0;
  int agreeing = 0;  ///< sweeps since
};

using TrackingState = std::variant<WaitingForStart, Tracking, Lost, FoundAgain>;

/// What a sweep came to.
enum class Placement : std::uint8_t {
  not_tried,  ///< no points, or no map yet
  failed,
  doubtful,  ///< found, but a search did so where inertia does not have it, or surfaces do not fit that are to bear it
             ///< out
  found,
};

TrackingState after_sweep(const TrackingState& before, Placement placement, SweepVerdict verdict);

/// Whether a sweep that came to this says that the place found again is none.
bool contradicts(const TrackingState& before, Placement placement);
/// As it is once the place found again is given up.
Lost given_up(const TrackingState& found_again);

bool has_started(const TrackingState& state);
bool is_lost(const TrackingState& state);
bool is_to_be_borne_out(const TrackingState& state);
int lost_sweeps(const TrackingState& state);      ///< 0 unless lost
int failed_searches(const TrackingState& state);  ///< in a row

}  // namespace tumble::mapping
