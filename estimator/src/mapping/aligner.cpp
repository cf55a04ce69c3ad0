// SPDX-License-Identifier: BSD-3-Clause
#include "aligner.hpp"

#include <algorithm>
#include <memory>

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

}  // namespace tumble::mapping
