// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>

#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// tracking.hpp defines the tracking state of the sensor relative to the map, and the transitions of the state.
namespace tumble::mapping {

struct WaitingForStart {};

/// Tracking is the normal state. A sweep without registration may still be accepted, by a certain prior or after the
/// search was abandoned.
struct Tracking {
  int failed_searches = 0;  ///< consecutive sweeps with points but without registration
};

struct Lost {
  int sweeps = 1;  ///< consecutive rejected sweeps
  int failed_searches = 0;
};

/// Relocalised is the state after a relocalisation that is not yet confirmed. Inertial prediction continues in parallel
/// (DeadReckoning), and replaces the relocalisation if a sweep contradicts the relocalisation. See mapping.md (R67),
/// (R68).
struct Relocalised {
  int after_sweeps = 0;  ///< number of rejected sweeps before the relocalisation
  int failed_searches = 0;
  int agreeing = 0;  ///< number of confirming sweeps
};

using TrackingState = std::variant<WaitingForStart, Tracking, Lost, Relocalised>;

/// RegistrationOutcome is the result of registering one sweep.
enum class RegistrationOutcome : std::uint8_t {
  not_tried,  ///< no points, or no map yet
  failed,
  relocalisation_unconfirmed,  ///< found by a search, but not yet confirmed
  found,
};

TrackingState after_sweep(const TrackingState& before, RegistrationOutcome placement, SweepVerdict verdict);

/// Returns whether a sweep with the given placement contradicts the relocalisation.
bool contradicts(const TrackingState& before, RegistrationOutcome placement);
/// Returns the state after a relocalisation is reverted.
Lost after_reverted_relocalisation(const TrackingState& relocalised);

bool has_started(const TrackingState& state);
bool is_lost(const TrackingState& state);
bool is_unconfirmed(const TrackingState& state);
int consecutive_rejected_sweeps(const TrackingState& state);  ///< 0 unless tracking failed
int failed_searches(const TrackingState& state);              ///< number of consecutive failed searches

}  // namespace tumble::mapping
