// SPDX-License-Identifier: BSD-3-Clause
#include "relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

// maximum iterations of the registration with all points, with a subset of the points, and of the coarse registration
// for initial poses far from the prior
constexpr int kFullIterations = 8, kSubsampledIterations = 30, kCoarseIterations = 15;
constexpr std::size_t kSubsamplePoints = 1000, kCoarsePoints = 300, kCoarseMatchesMin = 50;
constexpr double kCoarseKernelMin_m = 0.5;  // minimum width of the robust kernel
constexpr double kCoarseRematch_m = 0.2;    // distance by which a point moves before its plane is searched again
constexpr double kCoarseStep_m = 5e-3, kCoarseStep_rad = 2e-3;  // largest position and rotation step at convergence
constexpr double kCoarseInlierRatioMin = 0.2;  // minimum fraction of matches within three standard deviations

Registration::Params full_registration_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out = registration_params(params);
  out.expert.iterations_max = kFullIterations;
  return out;
}

constexpr double kCoarseReach = 2.0;

/// The coarse registration only has to reach the region of convergence of the registration with more points.
Registration::Params coarse_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out = registration_params(params);
  out.match_distance_m =
      std::min(kCoarseReach * params.expert.matching.distance_m, Registration::Params::kMatchDistanceMax_m);
  out.expert.iterations_max = kCoarseIterations;
  out.expert.matches_min = kCoarseMatchesMin;
  out.expert.kernel_min_m = kCoarseKernelMin_m;
  out.expert.rematch_m = kCoarseRematch_m;
  out.expert.step_m = kCoarseStep_m;
  out.expert.step_rad = kCoarseStep_rad;
  out.expert.inlier_ratio_min = kCoarseInlierRatioMin;
  // The inertial prediction is no evidence for a displaced starting pose, so the required number of matches is not
  // reduced if the registered pose agrees with the prediction.
  out.expert.agreeing_matches_needed = kCoarseMatchesMin;
  return out;
}

void select_evenly(std::span<const SweepPoint> points, std::size_t count, std::vector<SweepPoint>& out) {
  out.clear();
  const std::size_t every = std::max<std::size_t>(1, (points.size() + count - 1) / count);
  for (std::size_t i = 0; i < points.size(); i += every) out.push_back(points[i]);
}

void align(Registration& registration, const Registration::Prior& prior, const RegistrationScene& scene,
           std::span<const SweepPoint> points, SweepTrajectory& trajectory, Registration::Result& found) {
  // add_sweep() ensures that the IMU samples cover the sweep, so align() cannot fail.
  const Status status = registration.align(prior, scene.samples, scene.end_ns, points, scene.map, trajectory, found);
  if (!status.ok()) found.verdict = RegistrationVerdict::diverged;
}

Registration::Prior from(const Registration::Result& found, const Registration::Prior& prior) {
  Registration::Prior out = prior;
  out.start = found.mean.state;
  out.initial_saturation_deficit_rad_s = found.mean.saturation_deficit_rad_s;
  return out;
}

constexpr int kAgreeing = 2;  // number of sweeps that confirm a relocalisation; a single sweep may fit by chance

bool is_registered(RegistrationOutcome placement) {
  return placement == RegistrationOutcome::alignment_found ||
         placement == RegistrationOutcome::relocalisation_unconfirmed;
}

// A sweep confirms a relocalisation if at least the fraction kConfirmInlierRatio of the point-to-plane residuals is
// within three standard deviations. If the residuals are normally distributed, 99.7 % of the residuals are within three
// standard deviations.
constexpr double kConfirmInlierRatio = 0.9;
// maximum number of repetitions of a failed registration per sweep; each repetition starts with a larger saturation
// deficit of the gyro
constexpr int kDeficitTriesMax = 5;
// smallest increase of the gyro's initial saturation deficit in a repeated registration
constexpr double kDeficitTry_rad_s = 3.0;
// number of starting poses per sweep after a tracking failure, including the predicted pose
constexpr int kStartsPerSweep = 3;

using Params = LidarInertialOdometry::Params;

// A repeated registration increases the gyro's initial saturation deficit by kDeficitTry_rad_s times an element of
// kDeficitTries.
constexpr double kDeficitTries[] = {1.0, 2.0, 3.0, 5.0};
constexpr double kDeficitSigmas = 5.0;  // largest tried increase of the saturation deficit, in standard deviations

constexpr int kStartsPerRound = 12;  // number of initial poses per round: six axes, two directions
constexpr double kStartSigmas = 1.5;
constexpr double kShiftMin_m = 0.3, kRotationMin_rad = 0.1;  // closer starting poses converge to one pose
// In round n of the search, a starting pose differs from the predicted pose by at most n times kShift_m or n times
// kRotation_rad: mapping.md (R66).
constexpr double kShift_m = 1.0, kRotation_rad = 0.3;
constexpr int kRounds = 3;

bool converged(const Registration::Result& found) {
  return found.verdict == RegistrationVerdict::converged;
}

/// See mapping.md (R68).
bool is_sufficient_fit(const Registration::Result& found) {
  return double(found.inliers) >= kConfirmInlierRatio * double(found.matches);
}

/// Gyro saturation during a sweep may cause an error of a radian in the predicted attitude. A failed registration is
/// therefore repeated with larger saturation deficits of the clipped gyro axes.
void track_sweep(const Params& params, const Registration::Prior& prior, const RegistrationScene& scene,
                 SweepAligner& aligner, SweepTrajectory& trajectory, Registration::Result& found) {
  aligner.align_with_all_points(prior, scene, trajectory, found);
  int iterations = found.iterations, tries = 0;
  // If the first registration exceeds the limits of the pose correction, further registrations would also exceed the
  // limits.
  const bool out_of_bounds = found.correction_m > params.expert.matching.correction_max_m ||
                             found.correction_rad > params.expert.matching.correction_max_rad;
  if (found.verdict == RegistrationVerdict::diverged && !out_of_bounds) {
    aligner.align_to_convergence(prior, scene, trajectory, found);
    iterations += found.iterations;
  }
  for (const double times : kDeficitTries) {
    const double more = times * kDeficitTry_rad_s;
    for (int axis = 0; axis < 3; ++axis) {
      if (converged(found) || tries == kDeficitTriesMax) break;
      const int first = unknowns::saturation_deficit_index(axis, 0);
      if (std::sqrt(prior.covariance(first, first)) < more / kDeficitSigmas) continue;
      const auto start = std::make_unique<Registration::Prior>(prior);
      start->initial_saturation_deficit_rad_s.row(axis).array() += more;
      aligner.align_coarse_to_fine(*start, prior, scene, trajectory, found);
      iterations += found.iterations;
      ++tries;
    }
  }
  found.iterations = iterations;
}

/// The starting pose with index 0 is the predicted pose. Each starting pose with a higher index is shifted along one
/// axis or rotated about one axis. Starting poses close to the predicted pose have lower indices: mapping.md (R66).
void displace_starting_pose(int index, Registration::Prior& prior) {
  if (index == 0) return;
  const int round = 1 + (index - 1) / kStartsPerRound;
  const int axis = (index - 1) / 2 % 6;
  const double sign = (index - 1) % 2 == 0 ? 1.0 : -1.0;
  const double sigma = std::sqrt(prior.covariance(axis, axis));
  MotionState& state = prior.mean.state;
  if (axis < 3) {
    state.p_WI_m[axis] += sign * std::clamp(kStartSigmas * sigma, kShiftMin_m, round * kShift_m);
  } else {
    const double angle = sign * std::clamp(kStartSigmas * sigma, kRotationMin_rad, round * kRotation_rad);
    state.q_WI = so3::exp(angle * Eigen::Vector3d::Unit(axis - 3)) * state.q_WI;
  }
}

/// The number of starting poses per sweep is limited. If the search fails, the search continues with other starting
/// poses in the next sweep.
void search_displaced_poses(const RelocalisationContext& from, const RegistrationScene& scene, SweepAligner& aligner,
                            SweepTrajectory& trajectory, Registration::Result& found) {
  const Registration::Prior& prior = from.prior;
  if (from.contradicted_motion != nullptr) {
    const auto start = std::make_unique<Registration::Prior>(prior);
    start->mean.state = *from.contradicted_motion;
    aligner.align_coarse_to_fine(*start, prior, scene, trajectory, found);
    if (converged(found) && is_sufficient_fit(found)) return;
  }
  struct BestAlignment {
    Registration::Result alignment;
    SweepTrajectory trajectory;
  };
  std::unique_ptr<BestAlignment> best;
  aligner.align_coarse_to_fine(prior, prior, scene, trajectory, found);
  const RegistrationVerdict verdict = found.verdict;  // verdict of the sweep if the search fails
  const int moved = kStartsPerSweep - 1;
  for (int k = 0; k < moved && !(converged(found) && is_sufficient_fit(found)); ++k) {
    if (converged(found) && (!best || found.inliers > best->alignment.inliers))
      best = std::make_unique<BestAlignment>(BestAlignment{found, trajectory});
    const int index = 1 + (failed_searches(from.tracking) * moved + k) % (kStartsPerRound * kRounds);
    const auto start = std::make_unique<Registration::Prior>(prior);
    displace_starting_pose(index, *start);
    aligner.align_coarse_to_fine(*start, prior, scene, trajectory, found);
  }
  if (best && !(converged(found) && (is_sufficient_fit(found) || found.inliers >= best->alignment.inliers))) {
    found = best->alignment;
    trajectory = best->trajectory;
  }
  if (!converged(found)) found.verdict = verdict;
}

}  // namespace

SweepAligner::SweepAligner(const LidarInertialOdometry::Params& params)
    : full_registration_(full_registration_params(params)),
      subsampled_registration_(registration_params(params)),
      coarse_registration_(coarse_params(params)) {}

void SweepAligner::align_with_all_points(const Registration::Prior& prior, const RegistrationScene& scene,
                                         SweepTrajectory& trajectory, Registration::Result& found) {
  align(full_registration_, prior, scene, scene.points, trajectory, found);
}

void SweepAligner::align_to_convergence(const Registration::Prior& prior, const RegistrationScene& scene,
                                        SweepTrajectory& trajectory, Registration::Result& found) {
  select_evenly(scene.points, kSubsamplePoints, subsampled_points_);
  align(subsampled_registration_, prior, scene, subsampled_points_, trajectory, found);
  if (found.verdict != RegistrationVerdict::converged) return;
  const int iterations = found.iterations;
  const std::unique_ptr<const Registration::Prior> here(new Registration::Prior(from(found, prior)));
  align_with_all_points(*here, scene, trajectory, found);
  found.iterations += iterations;
}

void SweepAligner::align_coarse_to_fine(const Registration::Prior& start, const Registration::Prior& prior,
                                        const RegistrationScene& scene, SweepTrajectory& trajectory,
                                        Registration::Result& found) {
  select_evenly(scene.points, kCoarsePoints, subsampled_points_);
  const auto rough = std::make_unique<Registration::Result>();
  align(coarse_registration_, start, scene, subsampled_points_, trajectory, *rough);
  found.verdict = rough->verdict;
  if (rough->verdict != RegistrationVerdict::converged) return;
  const std::unique_ptr<const Registration::Prior> near(new Registration::Prior(from(*rough, prior)));
  align_to_convergence(*near, scene, trajectory, found);
}

Registration::Params registration_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out;
  out.neighbours = MatchingParams::kNeighbours;
  out.match_distance_m = params.expert.matching.distance_m;
  out.expert.iterations_max = kSubsampledIterations;
  out.skew_sigma_m_s = params.expert.matching.skew_sigma_m_s;
  out.expert.correction_max_m = params.expert.matching.correction_max_m;
  out.expert.correction_max_rad = params.expert.matching.correction_max_rad;
  out.expert.matches_min = MatchingParams::kMatchesMin;
  out.expert.agreeing_matches_needed = params.expert.matching.agreeing_matches_min;
  out.parallel_for = params.parallel_for;
  return out;
}

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

RegistrationAttempt attempt_registration(const Params& params, const RelocalisationContext& from,
                                         const RegistrationScene& scene, SweepAligner& aligner,
                                         SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment) {
  Registration::Result& found = alignment.emplace();
  found.points = scene.points.size();
  if (is_lost(from.tracking)) {
    search_displaced_poses(from, scene, aligner, trajectory, found);
  } else {
    track_sweep(params, from.prior, scene, aligner, trajectory, found);
  }
  RegistrationAttempt out;
  out.iterations = found.iterations;
  out.inlier_ratio = found.points == 0 ? 0.0 : double(found.inliers) / double(found.points);
  out.too_few_matches = found.verdict == RegistrationVerdict::too_few_matches;
  if (!converged(found)) alignment.reset();
  return out;
}

void judge_registration(const TrackingState& before, std::size_t points, bool prior_certain,
                        const RegistrationAttempt& attempt, SweepRegistration& out) {
  if (out.alignment) {
    const bool holds = out.alignment->least_constrained_sigma_m <= MatchingParams::kDegenerateSigma_m;
    out.verdict = holds ? SweepVerdict::registered : SweepVerdict::degenerate;
    const bool fits = double(out.alignment->inliers) >= kConfirmInlierRatio * double(out.alignment->matches);
    const bool relocalisation_unconfirmed =
        (is_lost(before) && !(out.agrees_with_prediction && fits)) || (is_unconfirmed_relocalisation(before) && !fits);
    out.outcome = relocalisation_unconfirmed ? RegistrationOutcome::relocalisation_unconfirmed
                                             : RegistrationOutcome::alignment_found;
    return;
  }
  const bool enough = points >= MatchingParams::kMatchesMin;
  const bool given_up = failed_searches(before) + 1 >= TrackingLimits::kLostSweepsMax;
  out.outcome = RegistrationOutcome::failed;
  out.map_too_sparse = enough && attempt.too_few_matches;
  if (enough && ((attempt.too_few_matches && prior_certain) || given_up)) out.verdict = SweepVerdict::degenerate;
}

}  // namespace tumble::mapping
