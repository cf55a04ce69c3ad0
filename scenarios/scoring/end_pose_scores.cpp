// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/scoring/registered_sweeps.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

// The scores exclude a last sweep that the primary IMU covers only partly, because some methods drop this sweep and
// other methods shorten this sweep.
std::int64_t last_sweep_before_ns(const sim::Sensors& sensors) {
  constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
  if (sensors.lidars.empty() || sensors.imus.empty() || sensors.imus.front().time_ns.empty()) return kAll;
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const std::int64_t length_ns = lidar.point_times == sim::PointTimes::measured ? lidar.sweep_period_ns : 0;
  const std::int64_t covered_ns = sensors.imus.front().time_ns.back() - length_ns;
  const auto after = std::upper_bound(lidar.sweep_start_ns.begin(), lidar.sweep_start_ns.end(), covered_ns);
  if (lidar.sweep_period_ns <= 0 || after == lidar.sweep_start_ns.begin()) return kAll;
  return *(after - 1) + length_ns + lidar.sweep_period_ns / 4;
}

const LidarInertialOdometry::SweepResult* last_covered(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  const TruthTrack& truth = truth_track(scored);
  const std::int64_t before_ns = last_sweep_before_ns(scored.sensors());
  const auto covered = [&](const auto& sweep) {
    return truth.covers(sweep.pose.time_ns) && sweep.pose.time_ns <= before_ns;
  };
  const auto last = std::find_if(estimate.sweeps.rbegin(), estimate.sweeps.rend(), covered);
  return last == estimate.sweeps.rend() ? nullptr : &*last;
}

bool ends_of(const ScoredEstimate& scored, PoseState& first, PoseState& last) {
  const Estimate& estimate = scored.estimate();
  if (estimate.sweeps.empty()) {  // trajectory of an external program
    const PairedTrack& track = paired_track(scored);
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
  const auto* last_sweep = last_covered(scored);
  if (last_sweep == nullptr || last_sweep->pose.time_ns <= first.time_ns) return false;
  last = last_sweep->pose;
  return true;
}

struct EndError {
  Eigen::Vector3d translation_m;
  Eigen::Quaterniond rotation;
};

std::optional<EndError> end_pose_error(const ScoredEstimate& scored) {
  const TruthTrack& truth = truth_track(scored);
  PoseState first, last;
  if (!ends_of(scored, first, last)) return std::nullopt;
  const PoseState true_first = truth.pose(first.time_ns);
  const PoseState true_last = truth.pose(last.time_ns);
  EndError error;
  error.translation_m = first.orientation_W.conjugate() * (last.position_W_m - first.position_W_m) -
                        true_first.orientation_W.conjugate() * (true_last.position_W_m - true_first.position_W_m);
  error.rotation = (true_first.orientation_W.conjugate() * true_last.orientation_W).conjugate() *
                   (first.orientation_W.conjugate() * last.orientation_W);
  return error;
}

bool translation_error_end(const ScoredEstimate& scored, double& value) {
  const std::optional<EndError>& error = scored.once(end_pose_error);
  if (!error) return false;
  value = error->translation_m.norm();
  return true;
}

bool rotation_error_end(const ScoredEstimate& scored, double& value) {
  const std::optional<EndError>& error = scored.once(end_pose_error);
  if (!error) return false;
  value = rotation_angle_rad(error->rotation);
  return true;
}

// Computes the NEES of the last pose, after alignment at the first pose: the squared error normalised by the
// covariance, divided by six degrees of freedom. The mean NEES is 1 if the covariance is consistent.
bool pose_nees(const ScoredEstimate& scored, double& value) {
  if (scored.estimate().sweeps.empty() || scored.estimate().poses.empty()) return false;
  const auto* last_sweep = last_covered(scored);
  if (last_sweep == nullptr) return false;
  const PoseState& last = last_sweep->pose;
  if (last.covariance.diagonal().minCoeff() <= 0.0) return false;  // the estimate reports no covariance
  const Alignment& alignment = paired_track(scored).alignment;
  const PoseState aligned = alignment.apply(last);
  const PoseState true_pose = truth_track(scored).pose(last.time_ns);
  Eigen::Matrix<double, 6, 1> error;
  error << true_pose.position_W_m - aligned.position_W_m,
      so3::logarithm((true_pose.orientation_W * aligned.orientation_W.conjugate()).normalized());
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
        "translation error at the last sweep with IMU readings, relative to the sixth registered sweep. For an "
        "estimate without sweeps, the error at the last pose, relative to the first pose",
        Sense::lower, Place::headline},
       Kind::slam,
       translation_error_end},
      {{"rotation_error_end_rad", Unit::rad,
        "rotation error (0 to pi) at the last sweep with IMU readings, relative to the sixth registered sweep",
        Sense::lower, Place::headline},
       Kind::slam,
       rotation_error_end},
      {{"pose_nees", Unit::number,
        "normalised squared error (NEES) of the pose of the last sweep, per degree of freedom; the expected value is 1",
        Sense::two_sided, Place::held, 1.0},
       Kind::slam,
       pose_nees},
  };
}

}  // namespace tumble::scenarios
