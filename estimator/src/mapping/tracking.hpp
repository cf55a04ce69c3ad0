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

/// A place was found by the last sweep after a search, and nothing has borne it out yet. Today it is believed at once:
/// in all respects as Tracking. What is to be confirmed first stands here.
struct FoundAgain {
  int after_sweeps = 0;  ///< that were lost
};

using TrackingState = std::variant<WaitingForStart, Tracking, Lost, FoundAgain>;

/// What a sweep came to.
enum class Placement : std::uint8_t {
  not_tried,  ///< no points, or no map yet
  failed,
  found,
};

TrackingState after_sweep(const TrackingState& before, Placement placement, SweepVerdict verdict);

bool has_started(const TrackingState& state);
bool is_lost(const TrackingState& state);
int lost_sweeps(const TrackingState& state);      ///< 0 unless lost
int failed_searches(const TrackingState& state);  ///< in a row

}  // namespace tumble::mapping
