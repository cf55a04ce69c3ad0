// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

namespace tumble::mapping {

struct RegistrationAttempt {
  bool too_few_matches = false;  ///< an alignment failed because the map has too few points
  int iterations = 0;
  double inlier_ratio = 0.0;  ///< inlier fraction of the last registration
};

/// RelocalisationContext contains the possible IMU states at the start of a sweep. RelocalisationContext provides the
/// starting poses of the search.
struct RelocalisationContext {
  const TrackingState& tracking;
  const Registration::Prior& prior;
  /// IMU state of a relocalisation that later sweeps have contradicted, used as an additional starting pose; null
  /// without contradicted relocalisation
  const MotionState* contradicted_motion = nullptr;
};

/// `trajectory` receives the registered motion, or the last motion of a failed registration. If no registration
/// succeeds, `alignment` is empty.
RegistrationAttempt attempt_registration(const LidarInertialOdometry::Params& params, const RelocalisationContext& from,
                                         const RegistrationScene& scene, SweepAligner& aligner,
                                         SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

struct SweepRegistration {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool agrees_with_prediction = true;  ///< the registered pose agrees with the inertial prediction
  RegistrationOutcome outcome = RegistrationOutcome::not_attempted;
  bool map_too_sparse = false;                    ///< the sweep has points, but the map has too few nearby points
  std::optional<Registration::Result> alignment;  ///< alignment at the start of the sweep
};

/// If no registration succeeded, the verdict is `degenerate` in two cases: the map has too few points and the
/// prediction is certain, or enough searches have failed.
void judge_registration(const TrackingState& before, std::size_t points, bool prior_certain,
                        const RegistrationAttempt& attempt, SweepRegistration& placed);

/// The starting pose with index 0 is the predicted pose. Each starting pose with a higher index is shifted along one
/// axis or rotated about one axis. Starting poses close to the predicted pose have lower indices: mapping.md (R66).
void displace_starting_pose(int index, Registration::Prior& prior);

}  // namespace tumble::mapping
