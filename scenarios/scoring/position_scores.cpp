// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scenarios/scoring/families.hpp"
#include "scenarios/scoring/truth_track.hpp"

namespace tumble::scenarios {

namespace {

// a share of less than this path says nothing
constexpr double kPathMinM = 0.05;
constexpr double kUnmovedM = 0.02;  // before, nothing can be wrong

std::vector<PairedPose> paired(const Estimate& estimate, const ScoringInput& input) {
  return pair_poses(estimate, TruthTrack(*input.truth, estimate.frame)).poses;
}

bool end_error(const Estimate& estimate, const ScoringInput& input, double& value) {
  const std::vector<PairedPose> poses = paired(estimate, input);
  if (poses.empty()) return false;
  value = (poses.back().estimate.p_WA_m - poses.back().truth.p_WA_m).norm();
  return true;
}

bool end_error_share(const Estimate& estimate, const ScoringInput& input, double& value) {
  const std::vector<PairedPose> poses = paired(estimate, input);
  if (poses.empty()) return false;
  const double path_m = poses.back().path_m - poses.front().path_m;
  if (path_m < kPathMinM) return false;
  value = (poses.back().estimate.p_WA_m - poses.back().truth.p_WA_m).norm() / path_m;
  return true;
}

bool height_error_max(const Estimate& estimate, const ScoringInput& input, double& value) {
  const std::vector<PairedPose> poses = paired(estimate, input);
  if (poses.empty()) return false;
  value = 0.0;
  for (const PairedPose& pose : poses) {
    const double error = std::abs(pose.estimate.p_WA_m.z() - pose.truth.p_WA_m.z());
    // not std::max: a NaN has to come through
    if (!(error <= value)) value = error;
    if (std::isnan(value)) break;
  }
  return true;
}

bool rest_drift(const Estimate& estimate, const ScoringInput& input, double& value) {
  value = 0.0;
  bool any = false;
  Eigen::Vector3d error_at_start;
  bool resting = false;
  for (const PairedPose& pose : paired(estimate, input)) {
    const Eigen::Vector3d error = pose.estimate.p_WA_m - pose.truth.p_WA_m;
    if (pose.rest && resting) {
      any = true;
      const double drift = (error - error_at_start).norm();
      if (!(drift <= value)) value = drift;
      if (std::isnan(value)) break;
    } else if (pose.rest) {
      error_at_start = error;
    }
    resting = pose.rest;
  }
  return any;
}

/// In the axes that the covariance is stated in: those of the estimate's own world.
bool coverage_3sigma(const Estimate& estimate, const ScoringInput& input, double& value) {
  const PairedTrack track = pair_poses(estimate, TruthTrack(*input.truth, estimate.frame));
  const Eigen::Matrix3d R_estimate_W = track.alignment.transform().linear().transpose();
  std::size_t own = 0, total = 0, inside = 0;
  for (const PairedPose& pose : track.poses) {
    if (pose.path_m < kUnmovedM) continue;
    while (own < estimate.poses.size() && estimate.poses[own].time_ns < pose.time_ns) ++own;
    if (own == estimate.poses.size()) break;
    const Eigen::Vector3d variance = estimate.poses[own].covariance.topLeftCorner<3, 3>().diagonal();
    if (!(variance.maxCoeff() > 0.0)) continue;
    const Eigen::Vector3d error = R_estimate_W * (pose.estimate.p_WA_m - pose.truth.p_WA_m);
    for (int axis = 0; axis < 3; ++axis) inside += error[axis] * error[axis] <= 9.0 * variance[axis];
    total += 3;
  }
  if (total == 0) return false;
  value = static_cast<double>(inside) / static_cast<double>(total);
  return true;
}

}  // namespace

std::vector<Metric> position_metrics() {
  return {
      {"position_end_error_m", Kind::position, "m",
       "distance to the truth at the end, position and yaw aligned at the start", end_error},
      {"position_end_error_share", Kind::position, "1", "the same as a share of the true path", end_error_share},
      {"position_height_error_max_m", Kind::position, "m", "largest error of height", height_error_max},
      {"position_coverage_3sigma", Kind::position, "1",
       "share of the errors per axis, once it moves, within three stated standard deviations", coverage_3sigma},
      {"position_rest_drift_m", Kind::position, "m", "largest drift within one spell of standstill", rest_drift},
  };
}

}  // namespace tumble::scenarios
