// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/paths.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "scenarios/scoring/truth_track.hpp"

namespace tumble::tools {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using scenarios::Frame;

Vector3d drawn_point_B(const sim::Sensors& sensors, const sim::Truth& truth) {
  return sensors.sphere_radius_m > 0.0 ? truth.p_BG_m : Vector3d::Zero();
}

bool moves(const sim::Truth& truth, std::size_t k) {
  return truth.v_WB_m_s[k].norm() > 0.1 || truth.w_WB_B_rad_s[k].norm() > 0.2;
}

}  // namespace

Isometry3d pose_of(const PoseState& state) {
  Isometry3d T_WA = Isometry3d::Identity();
  T_WA.linear() = state.orientation_W.normalized().toRotationMatrix();
  T_WA.translation() = state.position_W_m;
  return T_WA;
}

bool given_mounting(Frame frame, const sim::Sensors& sensors, const sim::Truth* truth, Isometry3d& T_BA) {
  T_BA = Isometry3d::Identity();
  switch (frame) {
    case Frame::body:
      return true;
    case Frame::centre:
      if (truth != nullptr) T_BA.translation() = truth->p_BG_m;
      return true;
    case Frame::imu:
      if (sensors.imus.empty() || (truth != nullptr && truth->imus.empty())) return false;
      T_BA = sensors.imus.front().T_BI;
      return true;
    case Frame::lidar:
      if (sensors.lidars.empty() || (truth != nullptr && truth->lidars.empty())) return false;
      T_BA = sensors.lidars.front().T_BL;
      return true;
  }
  return false;
}

Path true_path(const sim::Sensors& sensors, const sim::Truth& truth, std::size_t stride) {
  Path path;
  const Vector3d point_B = drawn_point_B(sensors, truth);
  const auto add = [&](std::size_t k) {
    path.time_ns.push_back(static_cast<std::int64_t>(k) * truth.period_ns);
    path.points_W_m.push_back(truth.p_WB_m[k] + truth.q_WB[k] * point_B);
  };
  const std::size_t count = truth.p_WB_m.size();
  for (std::size_t k = 0; k < count; k += std::max<std::size_t>(stride, 1)) add(k);
  if (count > 0 && path.time_ns.back() != static_cast<std::int64_t>(count - 1) * truth.period_ns) add(count - 1);
  return path;
}

Path estimated_path(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth& truth) {
  Path path;
  Isometry3d T_BA;
  if (estimate.poses.empty() || truth.p_WB_m.empty()) return path;
  if (!given_mounting(estimate.frame, sensors, &truth, T_BA)) return path;

  const scenarios::TruthTrack track(truth, estimate.frame);
  const auto first = std::find_if(estimate.poses.begin(), estimate.poses.end(),
                                  [&](const PoseState& state) { return track.covers(state.time_ns); });
  if (first == estimate.poses.end()) return path;
  const Isometry3d move = scenarios::Alignment::at(*first, track.pose(first->time_ns)).transform();
  const Vector3d point_A = T_BA.inverse() * drawn_point_B(sensors, truth);
  for (const PoseState& state : estimate.poses) {
    if (!state.position_W_m.allFinite() || !state.orientation_W.coeffs().allFinite()) continue;
    path.time_ns.push_back(state.time_ns);
    path.points_W_m.push_back(move * (pose_of(state) * point_A));
  }
  return path;
}

Path near_truth(const Path& path, const Path& truth) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : truth.points_W_m) box.extend(point);
  if (box.isEmpty()) return path;
  const Vector3d margin = Vector3d::Constant(std::max(1.0, 0.5 * box.diagonal().norm()));
  box.extend(box.min() - margin);
  box.extend(box.max() + margin);
  const auto end =
      std::find_if(path.points_W_m.begin(), path.points_W_m.end(), [&](const Vector3d& p) { return !box.contains(p); });
  const auto count = end - path.points_W_m.begin();
  return {{path.time_ns.begin(), path.time_ns.begin() + count}, {path.points_W_m.begin(), end}, path.name};
}

Span moving_span(const sim::Truth& truth, double margin_s) {
  const std::size_t count = truth.p_WB_m.size();
  std::size_t begin = 0, end = count;
  while (begin < count && !moves(truth, begin)) ++begin;
  while (end > begin && !moves(truth, end - 1)) --end;
  const auto last_ns = static_cast<std::int64_t>(count == 0 ? 0 : count - 1) * truth.period_ns;
  if (begin >= end) return {0, last_ns};
  const auto margin_ns = static_cast<std::int64_t>(margin_s * 1e9);
  return {std::max<std::int64_t>(0, static_cast<std::int64_t>(begin) * truth.period_ns - margin_ns),
          std::min(last_ns, static_cast<std::int64_t>(end - 1) * truth.period_ns + margin_ns)};
}

}  // namespace tumble::tools
