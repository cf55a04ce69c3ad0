// SPDX-License-Identifier: BSD-3-Clause
#include "tracking.hpp"

namespace tumble::mapping {

TrackingState after_sweep(const TrackingState& before, Placement placement, SweepVerdict verdict) {
  const int failed = placement == Placement::found ? 0 : failed_searches(before) + (placement == Placement::failed);
  if (verdict == SweepVerdict::rejected) return Lost{lost_sweeps(before) + 1, failed};
  if (is_lost(before) && placement == Placement::found) return FoundAgain{lost_sweeps(before)};
  return Tracking{failed};
}

bool has_started(const TrackingState& state) {
  return !std::holds_alternative<WaitingForStart>(state);
}

bool is_lost(const TrackingState& state) {
  return std::holds_alternative<Lost>(state);
}

int lost_sweeps(const TrackingState& state) {
  const Lost* lost = std::get_if<Lost>(&state);
  return lost != nullptr ? lost->sweeps : 0;
}

int failed_searches(const TrackingState& state) {
  if (const Lost* lost = std::get_if<Lost>(&state)) return lost->failed_searches;
  if (const Tracking* tracking = std::get_if<Tracking>(&state)) return tracking->failed_searches;
  return 0;
}

}  // namespace tumble::mapping
