// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/motion.hpp"

#include <algorithm>

#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

namespace {

using Eigen::Isometry3d;
using scenarios::Alignment;
using scenarios::Frame;
using scenarios::TruthTrack;

constexpr double kFarthest_m = 1e4;
constexpr std::int64_t kGap_ns = 500'000'000;

PoseState state_of(std::int64_t time_ns, const Isometry3d& T_WA) {
  PoseState state;
  state.time_ns = time_ns;
  state.position_W_m = T_WA.translation();
  state.orientation_W = Eigen::Quaterniond(T_WA.linear());
  return state;
}

bool is_finite_pose(const PoseState& state) {
  return state.position_W_m.allFinite() && state.orientation_W.coeffs().allFinite() &&
         state.orientation_W.norm() > 1e-6;
}

Isometry3d to_truth(const scenarios::Estimate& estimate, const sim::Truth& truth) {
  const TruthTrack track(truth, estimate.frame);
  for (const PoseState& state : estimate.poses) {
    if (is_finite_pose(state) && track.covers(state.time_ns))
      return Alignment::at(state, track.pose(state.time_ns)).transform();
  }
  return Isometry3d::Identity();
}

Isometry3d to_reference(const std::vector<std::int64_t>& time_ns, const std::vector<Isometry3d>& T_WB,
                        const Motion& reference) {
  for (std::size_t i = 0; i < time_ns.size(); ++i) {
    const std::optional<Isometry3d> known = reference.at(time_ns[i]);
    if (known) return Alignment::at(state_of(time_ns[i], T_WB[i]), state_of(time_ns[i], *known)).transform();
  }
  return Isometry3d::Identity();
}

bool knows_positions(const sim::Truth& truth) {
  return std::any_of(truth.p_WB_m.begin(), truth.p_WB_m.end(), [](const auto& p) { return p.allFinite(); });
}

}  // namespace

Motion::Motion(const std::vector<std::int64_t>& time_ns, const std::vector<Isometry3d>& T_WB) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 0; i < std::min(time_ns.size(), T_WB.size()); ++i) {
    if (!T_WB[i].matrix().allFinite()) continue;
    if (!empty() && (time_ns[i] <= time_ns_.back() ||
                     (T_WB[i].translation() - p_WB_m_.front()).lpNorm<Eigen::Infinity>() > kFarthest_m))
      continue;
    if (!empty()) steps_ns.push_back(time_ns[i] - time_ns_.back());
    time_ns_.push_back(time_ns[i]);
    p_WB_m_.push_back(T_WB[i].translation());
    q_WB_.emplace_back(T_WB[i].linear());
  }
  if (!steps_ns.empty()) gap_ns_ = std::max(kGap_ns, 4 * scenarios::upper_median(std::move(steps_ns)));
}

std::optional<Isometry3d> Motion::at(std::int64_t time_ns) const {
  if (empty() || time_ns < begin_ns() || time_ns > end_ns()) return std::nullopt;
  const auto after = std::lower_bound(time_ns_.begin(), time_ns_.end(), time_ns);
  const auto next = static_cast<std::size_t>(after - time_ns_.begin());
  Isometry3d T_WB = Isometry3d::Identity();
  if (*after == time_ns) {
    T_WB.linear() = q_WB_[next].toRotationMatrix();
    T_WB.translation() = p_WB_m_[next];
    return T_WB;
  }
  const std::size_t here = next - 1;
  const std::int64_t step_ns = time_ns_[next] - time_ns_[here];
  if (step_ns > gap_ns_) return std::nullopt;
  const double share = static_cast<double>(time_ns - time_ns_[here]) / static_cast<double>(step_ns);
  T_WB.linear() = q_WB_[here].slerp(share, q_WB_[next]).toRotationMatrix();
  T_WB.translation() = (1.0 - share) * p_WB_m_[here] + share * p_WB_m_[next];
  return T_WB;
}

Motion true_motion(const sim::Truth& truth, std::int64_t step_ns) {
  if (!knows_positions(truth)) return {};
  const TruthTrack track(truth, Frame::body);
  std::vector<std::int64_t> time_ns;
  std::vector<Isometry3d> T_WB;
  for (std::int64_t t = 0; t <= track.last_ns(); t += std::max<std::int64_t>(step_ns, truth.period_ns)) {
    if (!track.covers(t)) continue;
    time_ns.push_back(t);
    T_WB.push_back(pose_of(track.pose(t)));
  }
  return {time_ns, T_WB};
}

Motion estimated_motion(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth* truth,
                        const Motion& reference) {
  Isometry3d T_BA;
  if (truth != nullptr && !knows_positions(*truth)) truth = nullptr;
  if (estimate.poses.empty() || !given_mounting(estimate.frame, sensors, truth, T_BA)) return {};
  const Isometry3d T_AB = T_BA.inverse();
  std::vector<std::int64_t> time_ns;
  std::vector<Isometry3d> T_WB;
  for (const PoseState& state : estimate.poses) {
    if (!is_finite_pose(state)) continue;
    time_ns.push_back(state.time_ns);
    T_WB.push_back(pose_of(state) * T_AB);
  }
  const Isometry3d move = truth != nullptr ? to_truth(estimate, *truth) : to_reference(time_ns, T_WB, reference);
  for (Isometry3d& pose : T_WB) pose = move * pose;
  return {time_ns, T_WB};
}

}  // namespace tumble::tools
