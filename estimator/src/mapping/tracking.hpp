// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>

#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

struct WaitingForStart {};

/// Tracking is the state after a sweep that was not rejected. A sweep with enough points, but without a successful
/// registration, is also accepted in two cases:
/// - The sweep has too few matches with the map, and the standard deviation of the predicted pose is small.
/// - The maximum number of consecutive failed searches is reached.
struct Tracking {
  int failed_searches = 0;  ///< consecutive sweeps with points but without registration
};

struct TrackingLost {
  int sweeps = 1;  ///< consecutive rejected sweeps
  int failed_searches = 0;
};

/// Relocalised is the state while a relocalisation is unconfirmed: mapping.md (R67), (R68). The inertial prediction
/// without relocalisation continues in parallel. If a later sweep contradicts the relocalisation, the predicted pose
/// replaces the relocalised pose.
struct Relocalised {
  int rejected_sweeps_before = 0;  ///< number of rejected sweeps before the relocalisation
  int failed_searches = 0;
  int agreeing_sweep_count = 0;  ///< number of sweeps that agree with the relocalisation
};

using TrackingState = std::variant<WaitingForStart, Tracking, TrackingLost, Relocalised>;

enum class RegistrationOutcome : std::uint8_t {
  not_attempted,  ///< no points, or no map yet
  failed,
  relocalisation_unconfirmed,  ///< found by a search, but not yet confirmed
  alignment_found,
};

TrackingState tracking_state_after_sweep(const TrackingState& before, RegistrationOutcome placement,
                                         SweepVerdict verdict);

bool contradicts_tracking(const TrackingState& before, RegistrationOutcome placement);
TrackingLost after_reverted_relocalisation(const TrackingState& relocalised);

bool has_started(const TrackingState& state);
bool is_lost(const TrackingState& state);
bool is_unconfirmed_relocalisation(const TrackingState& state);
int consecutive_rejected_sweeps(const TrackingState& state);  ///< number of rejected sweeps; 0 unless tracking failed
int failed_searches(const TrackingState& state);              ///< number of consecutive failed searches

}  // namespace tumble::mapping
