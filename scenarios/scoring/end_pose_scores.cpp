// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>

#include "scenarios/scoring/families.hpp"
#include "scenarios/scoring/registered_sweeps.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

// the last sweep that the truth reaches: clocks that are late stamp the end of a recording beyond it
const LidarInertialOdometry::SweepReport* last_covered(const Estimate& estimate, const TruthTrack& truth) {
  const auto covered = [&](const auto& sweep) { return truth.covers(sweep.pose.time_ns); };
  const auto last = std::find_if(estimate.sweeps.rbegin(), estimate.sweeps.rend(), covered);
  return last == estimate.sweeps.rend() ? nullptr : &*last;
}

// from where to where an end error is measured; false when there is no such motion
bool ends_of(const Estimate& estimate, const TruthTrack& truth, PoseState& first, PoseState& last) {
  if (estimate.sweeps.empty()) {  // a trajectory of somebody else
    const PairedTrack track = pair_poses(estimate, truth);
    if (track.poses.size() < 2) return false;
    const auto pose_at = [&](std::int64_t time_ns) {
      return *std::find_if(estimate.poses.begin(), estimate.poses.end(),
                           [&](const PoseState& pose) { return pose.time_ns == time_ns; });
    };
    first = pose_at(track.poses.front().time_ns);
    last = pose_at(track.poses.back().time_ns);
    return true;
  }
  const std::vector<std::size_t> registered = registered_sweeps(estimate);
  if (registered.size() < kStartSweep || registered[kStartSweep - 1] + 1 >= estimate.sweeps.size()) return false;
  first = estimate.sweeps[registered[kStartSweep - 1]].pose;
  const auto* last_sweep = last_covered(estimate, truth);
  if (last_sweep == nullptr || last_sweep->pose.time_ns <= first.time_ns) return false;
  last = last_sweep->pose;
  return true;
}

// estimated motion from the sixth registered sweep to the last sweep, seen from the true one
bool end_error(const Estimate& estimate, const ScoringInput& input, Eigen::Vector3d& translation,
               Eigen::Quaterniond& rotation) {
  const TruthTrack truth(*input.truth, estimate.frame);
  PoseState first, last;
  if (!ends_of(estimate, truth, first, last)) return false;
  const PoseState true_first = truth.pose(first.time_ns);
  const PoseState true_last = truth.pose(last.time_ns);
  translation = first.q_WA.conjugate() * (last.p_WA_m - first.p_WA_m) -
                true_first.q_WA.conjugate() * (true_last.p_WA_m - true_first.p_WA_m);
  rotation = (true_first.q_WA.conjugate() * true_last.q_WA).conjugate() * (first.q_WA.conjugate() * last.q_WA);
  return true;
}

bool translation_error_end(const Estimate& estimate, const ScoringInput& input, double& value) {
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
  if (!end_error(estimate, input, translation, rotation)) return false;
  value = translation.norm();
  return true;
}

bool rotation_error_end(const Estimate& estimate, const ScoringInput& input, double& value) {
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
  if (!end_error(estimate, input, translation, rotation)) return false;
  value = rotation_angle_rad(rotation);
  return true;
}

// of the last sweep's pose, aligned at the first pose, against its own reported covariance: mean 1 when that holds
bool pose_nees(const Estimate& estimate, const ScoringInput& input, double& value) {
  if (estimate.sweeps.empty() || estimate.poses.empty()) return false;
  const TruthTrack truth(*input.truth, estimate.frame);
  const auto* last_sweep = last_covered(estimate, truth);
  if (last_sweep == nullptr) return false;
  const PoseState& last = last_sweep->pose;
  if (last.covariance.diagonal().minCoeff() <= 0.0) return false;  // none reported
  const Alignment alignment = pair_poses(estimate, truth).alignment;
  const PoseState aligned = alignment.apply(last);
  const PoseState true_pose = truth.pose(last.time_ns);
  Eigen::Matrix<double, 6, 1> error;
  error << true_pose.p_WA_m - aligned.p_WA_m, so3::log((true_pose.q_WA * aligned.q_WA.conjugate()).normalized());
  // the covariance is in the estimator's world: its error is turned there
  const Eigen::Matrix3d back = alignment.transform().linear().transpose();
  error << Eigen::Vector3d(back * error.head<3>()), Eigen::Vector3d(back * error.tail<3>());
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(last.covariance);
  if (factor.info() != Eigen::Success) return false;
  value = factor.matrixL().solve(error).squaredNorm() / 6.0;
  return true;
}

}  // namespace

std::vector<std::size_t> registered_sweeps(const Estimate& estimate) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < estimate.sweeps.size(); ++k) {
    if (estimate.sweeps[k].verdict != SweepVerdict::rejected) indices.push_back(k);
  }
  return indices;
}

std::vector<Metric> end_pose_metrics() {
  return {
      {{"translation_error_end_m", Unit::m,
        "error of the motion from the sixth registered sweep to the last sweep (of a trajectory without sweeps, from "
        "its "
        "first pose to its last): translation",
        Sense::lower, Place::headline},
       Kind::slam,
       translation_error_end},
      {{"rotation_error_end_rad", Unit::rad,
        "error of the motion from the sixth registered sweep to the last sweep: rotation, up to pi", Sense::lower,
        Place::headline},
       Kind::slam,
       rotation_error_end},
      {{"pose_nees", Unit::number,
        "squared error of the last sweep's pose over its reported covariance, per degree of freedom", Sense::two_sided,
        Place::held, 1.0},
       Kind::slam,
       pose_nees},
  };
}

}  // namespace tumble::scenarios
