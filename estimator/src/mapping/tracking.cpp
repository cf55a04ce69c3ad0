// SPDX-License-Identifier: BSD-3-Clause
#include "tracking.hpp"

namespace tumble::mapping {

namespace {

constexpr int kAgreeing = 2;  // number of sweeps that confirm a relocalisation; a single sweep may fit by chance

bool is_registered(RegistrationOutcome placement) {
  return placement == RegistrationOutcome::alignment_found ||
         placement == RegistrationOutcome::relocalisation_unconfirmed;
}

}  // namespace

TrackingState tracking_state_after_sweep(const TrackingState& before, RegistrationOutcome placement,
                                         SweepVerdict verdict) {
  const int failed =
      is_registered(placement) ? 0 : failed_searches(before) + (placement == RegistrationOutcome::failed);
  if (verdict == SweepVerdict::rejected) return TrackingLost{consecutive_rejected_sweeps(before) + 1, failed};
  if (is_lost(before) && placement == RegistrationOutcome::relocalisation_unconfirmed)
    return Relocalised{consecutive_rejected_sweeps(before), failed_searches(before), 0};
  if (const Relocalised* found = std::get_if<Relocalised>(&before);
      found != nullptr && found->agreeing_sweep_count + 1 < kAgreeing)
    return Relocalised{found->rejected_sweeps_before, found->failed_searches, found->agreeing_sweep_count + 1};
  return Tracking{failed};
}

bool contradicts_tracking(const TrackingState& before, RegistrationOutcome placement) {
  return is_unconfirmed_relocalisation(before) && placement != RegistrationOutcome::alignment_found;
}

TrackingLost after_reverted_relocalisation(const TrackingState& relocalised) {
  const Relocalised* found = std::get_if<Relocalised>(&relocalised);
  if (found == nullptr) return {};
  return {found->rejected_sweeps_before + 1 + found->agreeing_sweep_count, found->failed_searches + 1};
}

bool has_started(const TrackingState& state) {
  return !std::holds_alternative<WaitingForStart>(state);
}

bool is_lost(const TrackingState& state) {
  return std::holds_alternative<TrackingLost>(state);
}

bool is_unconfirmed_relocalisation(const TrackingState& state) {
  return std::holds_alternative<Relocalised>(state);
}

int consecutive_rejected_sweeps(const TrackingState& state) {
  const TrackingLost* lost = std::get_if<TrackingLost>(&state);
  return lost != nullptr ? lost->sweeps : 0;
}

int failed_searches(const TrackingState& state) {
  if (const TrackingLost* lost = std::get_if<TrackingLost>(&state)) return lost->failed_searches;
  if (const Tracking* tracking = std::get_if<Tracking>(&state)) return tracking->failed_searches;
  return 0;
}

}  // namespace tumble::mapping
