// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/consistency.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

namespace {

// Shortest path for which a relative position error is computed [m]
constexpr double kPathMinM = 0.05;
constexpr double kUnmovedM = 0.02;  // scores start after this motion

bool end_error(const ScoredEstimate& scored, double& value) {
  const std::vector<PairedPose>& poses = paired_track(scored).poses;
  if (poses.empty()) return false;
  value = (poses.back().estimate.position_W_m - poses.back().truth.position_W_m).norm();
  return true;
}

/// Divides the end error by the path length of the body's centre, which is the centre of a sphere, or the centre of
/// mass of any other body. A sensor that turns around the body's centre has a longer path, so the path of the sensor
/// would give a smaller relative error.
bool end_error_share(const ScoredEstimate& scored, double& value) {
  const std::vector<PairedPose>& poses = paired_track(scored).poses;
  if (poses.empty()) return false;
  const TruthTrack centre(scored.truth(), Frame::centre);
  const double path_m = centre.path_m(poses.back().time_ns) - centre.path_m(poses.front().time_ns);
  if (path_m < kPathMinM) return false;
  value = (poses.back().estimate.position_W_m - poses.back().truth.position_W_m).norm() / path_m;
  return true;
}

bool height_error_max(const ScoredEstimate& scored, double& value) {
  const std::vector<PairedPose>& poses = paired_track(scored).poses;
  if (poses.empty()) return false;
  value = 0.0;
  for (const PairedPose& pose : poses) {
    const double error = std::abs(pose.estimate.position_W_m.z() - pose.truth.position_W_m.z());
    // The condition !(error <= value) is true for a NaN error, so that a NaN error becomes the maximum; std::max would
    // ignore NaN.
    if (!(error <= value)) value = error;
    if (std::isnan(value)) break;
  }
  return true;
}

std::vector<double> normalised_position_errors(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  const PairedTrack& track = paired_track(scored);
  const Eigen::Matrix3d R_estimate_W = track.alignment.transform().linear().transpose();
  std::vector<double> normalised;
  std::size_t own = 0;
  for (const PairedPose& pose : track.poses) {
    if (pose.path_m < kUnmovedM) continue;
    while (own < estimate.poses.size() && estimate.poses[own].time_ns < pose.time_ns) ++own;
    if (own == estimate.poses.size()) break;
    const Eigen::Vector3d variance = estimate.poses[own].covariance.topLeftCorner<3, 3>().diagonal();
    if (!(variance.maxCoeff() > 0.0)) continue;
    const Eigen::Vector3d error = R_estimate_W * (pose.estimate.position_W_m - pose.truth.position_W_m);
    for (int axis = 0; axis < 3; ++axis) normalised.push_back(squared_over(error[axis], variance[axis]));
  }
  return normalised;
}

bool position_coverage_3sigma(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_position_errors), value);
}

bool nees_median(const ScoredEstimate& scored, double& value) {
  return normalised_median(scored.once(normalised_position_errors), value);
}

}  // namespace

std::vector<Metric> position_metrics() {
  return {
      {{"position_end_error_m", Unit::m,
        "position error at the end; estimate and truth are aligned in position and yaw at the start", Sense::lower},
       Kind::position,
       end_error},
      {{"position_end_error_share", Unit::share, "position error at the end, divided by the length of the true path",
        Sense::lower, Place::headline},
       Kind::position,
       end_error_share},
      {{"position_height_error_max_m", Unit::m, "largest height error", Sense::lower, Place::held},
       Kind::position,
       height_error_max},
      {{"position_coverage_3sigma", Unit::share,
        "share of position errors (per axis, after motion starts) within three reported standard deviations",
        Sense::two_sided, Place::held, kNormal3Sigma, Compared::by_difference},
       Kind::position,
       position_coverage_3sigma},
      {{"position_nees_median", Unit::number,
        "consistency of the position covariance: median of squared error divided by reported variance, scaled so that "
        "a correct covariance gives 1",
        Sense::two_sided, Place::held, 1.0},
       Kind::position,
       nees_median},
  };
}

}  // namespace tumble::scenarios
