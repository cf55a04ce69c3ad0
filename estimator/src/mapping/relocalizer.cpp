// SPDX-License-Identifier: BSD-3-Clause
#include "relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

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
