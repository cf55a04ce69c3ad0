// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/truth_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

Eigen::Isometry3d mounting(const sim::Truth& truth, Frame frame) {
  switch (frame) {
    case Frame::imu:
      if (truth.imus.empty()) throw BadInput("the truth has no IMU, so poses of the frame 'imu' cannot be scored");
      return truth.imus.front().T_BI;
    case Frame::lidar:
      if (truth.lidars.empty())
        throw BadInput("the truth has no lidar, so poses of the frame 'lidar' cannot be scored");
      return truth.lidars.front().T_BL;
    case Frame::body:
      break;
    case Frame::centre:
      return Eigen::Isometry3d(Eigen::Translation3d(truth.p_BG_m));
  }
  return Eigen::Isometry3d::Identity();
}

std::vector<bool> rest_mask(const sim::Truth& truth) {
  const std::size_t count = truth.p_WB_m.size();
  const bool no_position =
      std::none_of(truth.p_WB_m.begin(), truth.p_WB_m.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); });
  std::vector<std::size_t> moving_before(count + 1, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const bool slow = (no_position || truth.v_WB_m_s[k].norm() < TruthTrack::kRestSpeedMS) &&
                      truth.w_WB_B_rad_s[k].norm() < TruthTrack::kRestRateRadS;
    moving_before[k + 1] = moving_before[k] + (slow ? 0 : 1);
  }
  const auto reach =
      static_cast<std::size_t>(std::llround(TruthTrack::kRestWindowS * 1e9 / static_cast<double>(truth.period_ns)));
  std::vector<bool> rest(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k > reach ? k - reach : 0;
    const std::size_t last = std::min(count, k + reach + 1);
    rest[k] = moving_before[last] == moving_before[first];
  }
  return rest;
}

}  // namespace

TruthTrack::TruthTrack(const sim::Truth& truth, Frame frame) : truth_(&truth), T_BA_(mounting(truth, frame)) {
  const std::size_t count = truth.p_WB_m.size();
  if (count == 0) throw BadInput("the truth contains no motion samples");
  if (truth.period_ns <= 0)
    throw BadInput(fmt::format("truth.period_ns is {}; it must be greater than 0", truth.period_ns));
  require_length("truth", "q_WB", truth.q_WB.size(), count);
  require_length("truth", "v_WB_m_s", truth.v_WB_m_s.size(), count);
  require_length("truth", "w_WB_B_rad_s", truth.w_WB_B_rad_s.size(), count);
  last_ns_ = static_cast<std::int64_t>(count - 1) * truth.period_ns;
  path_m_.resize(count, 0.0);
  for (std::size_t k = 1; k < count; ++k) {
    path_m_[k] = path_m_[k - 1] + (known(k - 1) && known(k) ? (position(k) - position(k - 1)).norm() : 0.0);
  }
  rest_ = rest_mask(truth);
}

bool TruthTrack::attitude_known(std::size_t index) const {
  return truth_->q_WB[index].coeffs().allFinite();
}

bool TruthTrack::known(std::size_t index) const {
  return attitude_known(index) && truth_->p_WB_m[index].allFinite();
}

bool TruthTrack::covers_attitude(std::int64_t time_ns) const {
  if (time_ns < 0 || time_ns > last_ns_) return false;
  const auto index = static_cast<std::size_t>(time_ns / truth_->period_ns);
  return attitude_known(index) && (time_ns % truth_->period_ns == 0 || attitude_known(index + 1));
}

bool TruthTrack::covers(std::int64_t time_ns) const {
  if (time_ns < 0 || time_ns > last_ns_) return false;
  const auto index = static_cast<std::size_t>(time_ns / truth_->period_ns);
  return known(index) && (time_ns % truth_->period_ns == 0 || known(index + 1));
}

Eigen::Vector3d TruthTrack::position(std::size_t index) const {
  return truth_->p_WB_m[index] + truth_->q_WB[index] * T_BA_.translation();
}

TruthTrack::Between TruthTrack::between(std::int64_t time_ns) const {
  const auto index = static_cast<std::size_t>(time_ns / truth_->period_ns);
  const double share = static_cast<double>(time_ns % truth_->period_ns) / static_cast<double>(truth_->period_ns);
  return {index, share > 0.0 ? std::min(index + 1, truth_->p_WB_m.size() - 1) : index, share};
}

Eigen::Vector3d TruthTrack::body_rate_rad_s(std::int64_t time_ns) const {
  const auto [index, next, share] = between(time_ns);
  return (1.0 - share) * truth_->w_WB_B_rad_s[index] + share * truth_->w_WB_B_rad_s[next];
}

PoseState TruthTrack::pose(std::int64_t time_ns) const {
  const auto [index, next, share] = between(time_ns);
  const Eigen::Quaterniond q_WB = truth_->q_WB[index].slerp(share, truth_->q_WB[next]);
  const Eigen::Vector3d p_WB = (1.0 - share) * truth_->p_WB_m[index] + share * truth_->p_WB_m[next];
  const Eigen::Vector3d v_WB = (1.0 - share) * truth_->v_WB_m_s[index] + share * truth_->v_WB_m_s[next];
  const Eigen::Vector3d w_B = body_rate_rad_s(time_ns);

  PoseState pose;
  pose.time_ns = time_ns;
  pose.position_W_m = p_WB + q_WB * T_BA_.translation();
  pose.orientation_W = q_WB * Eigen::Quaterniond(T_BA_.linear());
  pose.velocity_W_m_s = v_WB + q_WB * w_B.cross(T_BA_.translation());
  return pose;
}

Eigen::Vector3d TruthTrack::rate_rad_s(std::int64_t time_ns) const {
  return T_BA_.linear().transpose() * body_rate_rad_s(time_ns);
}

double TruthTrack::path_m(std::int64_t time_ns) const {
  const auto [index, next, share] = between(time_ns);
  return (1.0 - share) * path_m_[index] + share * path_m_[next];
}

bool TruthTrack::at_rest(std::int64_t time_ns) const {
  return rest_[static_cast<std::size_t>(time_ns / truth_->period_ns)];
}

double twist_about_z_rad(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return 2.0 * std::atan2(sign * q.z(), sign * q.w());
}

double rotation_angle_rad(const Eigen::Quaterniond& q) {
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Alignment Alignment::at(const PoseState& estimate, const PoseState& truth) {
  Alignment alignment;
  alignment.yaw_rad = twist_about_z_rad(truth.orientation_W * estimate.orientation_W.conjugate());
  const Eigen::AngleAxisd turn(alignment.yaw_rad, Eigen::Vector3d::UnitZ());
  alignment.translation_m = truth.position_W_m - turn * estimate.position_W_m;
  return alignment;
}

Eigen::Isometry3d Alignment::transform() const {
  return Eigen::Translation3d(translation_m) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
}

PoseState Alignment::apply(const PoseState& pose) const {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  PoseState aligned = pose;
  aligned.position_W_m = turn * pose.position_W_m + translation_m;
  aligned.orientation_W = turn * pose.orientation_W;
  aligned.velocity_W_m_s = turn * pose.velocity_W_m_s;
  return aligned;
}

Eigen::Vector2d tilt_error_rad(const Eigen::Quaterniond& q_estimate, const Eigen::Quaterniond& q_true) {
  const Eigen::Vector3d up = q_estimate * (q_true.conjugate() * Eigen::Vector3d::UnitZ());
  const double sine = std::hypot(up.x(), up.y());
  const double scale = sine > 1e-12 ? std::atan2(sine, up.z()) / sine : 1.0;
  return scale * Eigen::Vector2d(up.y(), -up.x());
}

PairedTrack pair_poses(const Estimate& estimate, const TruthTrack& truth) {
  PairedTrack track;
  for (const PoseState& pose : estimate.poses) {
    if (!truth.covers(pose.time_ns)) continue;
    PairedPose pair;
    pair.time_ns = pose.time_ns;
    pair.truth = truth.pose(pose.time_ns);
    if (track.poses.empty()) track.alignment = Alignment::at(pose, pair.truth);
    pair.estimate = track.alignment.apply(pose);
    pair.path_m = truth.path_m(pose.time_ns);
    track.poses.push_back(pair);
  }
  return track;
}

}  // namespace tumble::scenarios
