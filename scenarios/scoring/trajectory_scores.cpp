// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kSegmentM = 1.0;
// Distance [m] between the starts of successive path segments. While the robot stands still, at most one path segment
// starts.
constexpr double kSegmentStepM = 0.05;

bool ate(const ScoredEstimate& scored, double& value) {
  const PairedTrack& track = paired_track(scored);
  if (track.poses.empty()) return false;
  std::vector<double> errors;
  for (const PairedPose& pose : track.poses)
    errors.push_back((pose.estimate.position_W_m - pose.truth.position_W_m).norm());
  value = rms(errors);
  return true;
}

bool ate_rotation(const ScoredEstimate& scored, double& value) {
  const PairedTrack& track = paired_track(scored);
  if (track.poses.empty()) return false;
  std::vector<double> errors;
  for (const PairedPose& pose : track.poses)
    errors.push_back(rotation_angle_rad(pose.truth.orientation_W.conjugate() * pose.estimate.orientation_W));
  value = rms(errors);
  return true;
}

struct SegmentErrors {
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
};

Eigen::Isometry3d relative(const PoseState& a, const PoseState& b) {
  const Eigen::Quaterniond q_Wa_inverse = a.orientation_W.conjugate();
  return Eigen::Translation3d(q_Wa_inverse * (b.position_W_m - a.position_W_m)) * (q_Wa_inverse * b.orientation_W);
}

SegmentErrors segment_errors(const ScoredEstimate& scored) {
  const PairedTrack& track = paired_track(scored);
  SegmentErrors errors;
  double next_start_m = -1.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    const PairedPose& start = track.poses[i];
    if (start.path_m < next_start_m) continue;
    next_start_m = start.path_m + kSegmentStepM;
    while (j < track.poses.size() && track.poses[j].path_m < start.path_m + kSegmentM) ++j;
    if (j == track.poses.size()) break;
    const Eigen::Isometry3d E = relative(start.truth, track.poses[j].truth).inverse(Eigen::Isometry) *
                                relative(start.estimate, track.poses[j].estimate);
    errors.translation_m.push_back(E.translation().norm());
    errors.rotation_rad.push_back(rotation_angle_rad(Eigen::Quaterniond(E.linear())));
  }
  return errors;
}

bool rpe_m(const ScoredEstimate& scored, double& value) {
  const SegmentErrors& errors = scored.once(segment_errors);
  if (errors.translation_m.empty()) return false;
  value = rms(errors.translation_m);
  return true;
}

bool rpe_rad(const ScoredEstimate& scored, double& value) {
  const SegmentErrors& errors = scored.once(segment_errors);
  if (errors.rotation_rad.empty()) return false;
  value = rms(errors.rotation_rad);
  return true;
}

}  // namespace

std::vector<Metric> trajectory_metrics(Kind kind) {
  return {
      {{"ate_m", Unit::m,
        "rms position error; position and yaw of the estimate are aligned with the truth at the start only",
        Sense::lower, Place::held},
       kind,
       ate},
      {{"ate_rad", Unit::rad,
        "rms rotation error (0 to pi), including the effect of wrong time stamps. The estimate is aligned with the "
        "truth in position and yaw, at the start only",
        Sense::lower, Place::held},
       kind,
       ate_rotation},
      {{"rpe_1m_m", Unit::m, "rms translation error of the relative motion over 1 m of true path", Sense::lower,
        Place::held},
       kind,
       rpe_m},
      {{"rpe_1m_rad", Unit::rad, "rms rotation error (0 to pi) of the relative motion over 1 m of true path",
        Sense::lower, Place::held},
       kind,
       rpe_rad},
  };
}

}  // namespace tumble::scenarios
