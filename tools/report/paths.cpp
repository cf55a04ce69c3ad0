// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/paths.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::tools {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using scenarios::Frame;

/// From the body frame's origin to the point whose path is drawn, in B.
Vector3d drawn_point_B(const sim::Sensors& sensors, const sim::Truth& truth) {
  return sensors.sphere_radius_m > 0.0 ? truth.p_BG_m : Vector3d::Zero();
}

/// Mounting of the frame that an estimate's poses belong to; `calibrated` as the estimator was given it, else true.
bool mounting(Frame frame, const sim::Sensors& sensors, const sim::Truth& truth, bool calibrated, Isometry3d& T_BA) {
  T_BA = Isometry3d::Identity();
  switch (frame) {
    case Frame::body: return true;
    case Frame::centre: T_BA.translation() = truth.p_BG_m; return true;
    case Frame::imu:
      if (sensors.imus.empty() || truth.imus.empty()) return false;
      T_BA = calibrated ? sensors.imus.front().T_BI : truth.imus.front().T_BI;
      return true;
    case Frame::lidar:
      if (sensors.lidars.empty() || truth.lidars.empty()) return false;
      T_BA = calibrated ? sensors.lidars.front().T_BL : truth.lidars.front().T_BL;
      return true;
  }
  return false;
}

/// The turn about the vertical that brings R_from nearest to R_to.
double yaw_between(const Eigen::Matrix3d& R_from, const Eigen::Matrix3d& R_to) {
  const Eigen::Matrix3d R = R_to * R_from.transpose();
  return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
}

Isometry3d pose_of(const PoseState& state) {
  Isometry3d T_WA = Isometry3d::Identity();
  T_WA.linear() = state.q_WA.normalized().toRotationMatrix();
  T_WA.translation() = state.p_WA_m;
  return T_WA;
}

bool moves(const sim::Truth& truth, std::size_t k) {
  return truth.v_WB_m_s[k].norm() > 0.1 || truth.w_WB_B_rad_s[k].norm() > 0.2;
}

}  // namespace

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

Isometry3d true_pose(const sim::Truth& truth, std::int64_t time_ns) {
  const auto last = static_cast<std::int64_t>(truth.p_WB_m.size()) - 1;
  const std::int64_t k = std::clamp<std::int64_t>(time_ns / truth.period_ns, 0, last);
  const std::int64_t next = std::min(k + 1, last);
  const double share = std::clamp(static_cast<double>(time_ns - k * truth.period_ns) / static_cast<double>(truth.period_ns), 0.0, 1.0);
  const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>(next);
  Isometry3d T_WB = Isometry3d::Identity();
  T_WB.linear() = truth.q_WB[a].slerp(share, truth.q_WB[b]).toRotationMatrix();
  T_WB.translation() = (1.0 - share) * truth.p_WB_m[a] + share * truth.p_WB_m[b];
  return T_WB;
}

Path estimated_path(const scenarios::Estimate& estimate, const sim::Sensors& sensors, const sim::Truth& truth) {
  Path path;
  Isometry3d T_BA_given, T_BA_true;
  if (estimate.poses.empty() || truth.p_WB_m.empty()) return path;
  if (!mounting(estimate.frame, sensors, truth, true, T_BA_given)) return path;
  if (!mounting(estimate.frame, sensors, truth, false, T_BA_true)) return path;

  const Isometry3d first = pose_of(estimate.poses.front());
  const Isometry3d truly_first = true_pose(truth, estimate.poses.front().time_ns) * T_BA_true;
  Isometry3d move = Isometry3d::Identity();
  move.linear() = Eigen::AngleAxisd(yaw_between(first.linear(), truly_first.linear()), Vector3d::UnitZ()).toRotationMatrix();
  move.translation() = truly_first.translation() - move.linear() * first.translation();

  const Vector3d point_A = T_BA_given.inverse() * drawn_point_B(sensors, truth);
  for (const PoseState& state : estimate.poses) {
    if (!state.p_WA_m.allFinite() || !state.q_WA.coeffs().allFinite()) continue;
    path.time_ns.push_back(state.time_ns);
    path.points_W_m.push_back(move * (pose_of(state) * point_A));
  }
  return path;
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
