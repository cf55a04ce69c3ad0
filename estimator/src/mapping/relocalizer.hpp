// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

struct RegistrationScene {
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< selected points of the sweep
  const VoxelMap& map;
};

/// SweepAligner registers a sweep to the map in stages, from few points to all points. `trajectory` receives the
/// registered motion of the IMU. If the registration fails, `trajectory` is invalid and the caller must rebuild
/// `trajectory`.
class SweepAligner {
 public:
  explicit SweepAligner(const LidarInertialOdometry::Params& params);

  /// Registers a sweep with all points and few iterations.
  void align_with_all_points(const Registration::Prior& prior, const RegistrationScene& scene,
                             SweepTrajectory& trajectory, Registration::Result& found);
  /// Registers a sweep first with a subset of its points until convergence, and then with all points.
  void align_to_convergence(const Registration::Prior& prior, const RegistrationScene& scene,
                            SweepTrajectory& trajectory, Registration::Result& found);
  /// Registers a sweep first with few points, because the initial pose `start` may be far from the solution.
  void align_coarse_to_fine(const Registration::Prior& start, const Registration::Prior& prior,
                            const RegistrationScene& scene, SweepTrajectory& trajectory, Registration::Result& found);

  const Registration& registration() const { return full_registration_; }

 private:
  Registration full_registration_, subsampled_registration_, coarse_registration_;
  std::vector<SweepPoint> subsampled_points_;
};

Registration::Params registration_params(const LidarInertialOdometry::Params& params);

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

}  // namespace tumble::mapping
