// SPDX-License-Identifier: BSD-3-Clause
#include "position_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../common/dense.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr double kGate = 16.27;  // 99.9 % quantile of chi-square with three degrees of freedom
constexpr std::size_t kPairsMin = 3, kPairsPerOutlier = 5;
constexpr double kHeadingSigma_rad = 0.1;
constexpr double kSpacing = 0.5;  // minimum distance of two stored positions, in standard deviations of a reading
constexpr double kDrift = 0.01;   // minimum assumed drift of the poses, as a fraction of the path

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

PoseState pose_at(const std::vector<PoseState>& trajectory, TimeNs time_ns) {
  const auto next = std::find_if(trajectory.begin(), trajectory.end() - 1,
                                 [&](const PoseState& pose) { return pose.time_ns >= time_ns; });
  PoseState out = *next;
  if (next == trajectory.begin()) return out;
  const PoseState& before = *(next - 1);
  const double share = seconds(time_ns - before.time_ns) / seconds(next->time_ns - before.time_ns);
  out.position_W_m = before.position_W_m + share * (next->position_W_m - before.position_W_m);
  out.orientation_W = before.orientation_W.slerp(share, next->orientation_W);
  return out;
}

PositionFrame fit_position_frame(const std::deque<PositionAlignment::PositionPair>& pairs) {
  Eigen::Vector3d mean_W_m = Eigen::Vector3d::Zero(), mean_P_m = mean_W_m;
  double weight = 0.0, sine = 0.0, cosine = 0.0, spread = 0.0;
  for (const auto& pair : pairs) {
    weight += 1.0 / pair.variance_m2;
    mean_W_m += pair.antenna_position_W_m / pair.variance_m2;
    mean_P_m += pair.antenna_position_P_m / pair.variance_m2;
  }
  mean_W_m /= weight;
  mean_P_m /= weight;
  for (const auto& pair : pairs) {
    const Eigen::Vector2d a = (pair.antenna_position_W_m - mean_W_m).head<2>(),
                          b = (pair.antenna_position_P_m - mean_P_m).head<2>();
    sine += (a.x() * b.y() - a.y() * b.x()) / pair.variance_m2;
    cosine += a.dot(b) / pair.variance_m2;
    spread += a.squaredNorm() / pair.variance_m2;
  }
  PositionFrame out;
  out.covariance_reference_point_W_m = mean_W_m;
  out.xyz_yaw_covariance_P.diagonal() << Eigen::Vector3d::Constant(1.0 / weight),
      spread > 0.0 ? 1.0 / spread : std::numeric_limits<double>::max();
  out.T_PW.linear() = so3::exp(std::atan2(sine, cosine) * kUp).toRotationMatrix();
  out.T_PW.translation() = mean_P_m - out.T_PW.linear() * mean_W_m;
  return out;
}

}  // namespace

Status PositionAlignment::add(const PositionReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most) {
  const Eigen::Matrix3d& covariance = reading.covariance_m2;
  if (!reading.antenna_position_P_m.allFinite() || !covariance.allFinite() ||
      !reading.antenna_lever_arm_I_m.allFinite())
    return {ErrorCode::non_finite, "position", std::numeric_limits<double>::quiet_NaN(), 0.0};
  const double least = covariance.diagonal().minCoeff();
  if (!(least > 0.0) || !covariance.isApprox(covariance.transpose(), 1e-6) || !dense::Cholesky(covariance).ok())
    return {ErrorCode::out_of_range, "covariance of the position", least, 0.0};
  const TimeNs time_ns = reading.time_ns;
  if (time_ns <= done_ns) return {ErrorCode::time_order, "time_ns", double(time_ns), double(done_ns)};
  if (time_ns > latest_ns) return {ErrorCode::out_of_range, "time_ns", double(time_ns), double(latest_ns)};
  if (waiting_readings_.size() >= most)
    return {ErrorCode::out_of_range, "positions waiting", double(waiting_readings_.size() + 1), double(most)};
  const auto later = [](TimeNs at_ns, const PositionReading& other) { return at_ns < other.time_ns; };
  waiting_readings_.insert(std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), time_ns, later),
                           reading);
  return {};
}

void PositionAlignment::add_sweep(const SweepResult& report) {
  if (report.trajectory.empty()) return;
  if (report.in_prior_map != in_prior_map_) restart_fit();
  in_prior_map_ = report.in_prior_map;
  path_m_ += (report.pose.position_W_m - last_position_W_m_).norm();
  last_position_W_m_ = report.pose.position_W_m;
  pose_variance_m2_ = report.pose.covariance.topLeftCorner<3, 3>().trace();
  bool any = false;
  for (; !waiting_readings_.empty() && waiting_readings_.front().time_ns <= report.pose.time_ns;
       waiting_readings_.pop_front()) {
    if (waiting_readings_.front().time_ns < report.trajectory.front().time_ns) continue;
    add_position_pair(waiting_readings_.front(), pose_at(report.trajectory, waiting_readings_.front().time_ns));
    any = true;
  }
  if (any) fit();
}

void PositionAlignment::restart_fit() {
  position_pairs_.clear();
  position_frame_.reset();
}

/// If the robot has hardly moved since the last position reading, the last and the new position reading are averaged.
void PositionAlignment::add_position_pair(const PositionReading& reading, const PoseState& pose) {
  const double variance_m2 = reading.covariance_m2.trace() / 3.0;
  const PositionPair pair{pose.position_W_m + pose.orientation_W * reading.antenna_lever_arm_I_m,
                          reading.antenna_position_P_m, variance_m2, path_m_, pose_variance_m2_};
  if (position_pairs_.empty() || (pair.antenna_position_W_m - position_pairs_.back().antenna_position_W_m).norm() >
                                     kSpacing * std::sqrt(variance_m2)) {
    if (position_pairs_.size() >= kMaxPositionPairs) position_pairs_.pop_front();
    position_pairs_.push_back(pair);
    return;
  }
  PositionPair& last = position_pairs_.back();
  const double share = last.variance_m2 / (last.variance_m2 + variance_m2);
  last.antenna_position_W_m += share * (pair.antenna_position_W_m - last.antenna_position_W_m);
  last.antenna_position_P_m += share * (pair.antenna_position_P_m - last.antenna_position_P_m);
  last.variance_m2 = share * variance_m2;
}

void PositionAlignment::fit() {
  position_frame_.reset();
  std::deque<PositionPair> inliers = position_pairs_;
  for (PositionPair& pair : inliers) {
    const double drift_m = kDrift * (path_m_ - pair.path_m);
    pair.variance_m2 += drift_m * drift_m + std::max(0.0, pose_variance_m2_ - pair.pose_variance_m2);
  }
  const std::size_t least = std::max(kPairsMin, position_pairs_.size() - position_pairs_.size() / kPairsPerOutlier);
  while (inliers.size() >= least) {
    const PositionFrame found = fit_position_frame(inliers);
    const auto misfit = [&](const PositionPair& pair) {
      return (found.T_PW * pair.antenna_position_W_m - pair.antenna_position_P_m).squaredNorm() / pair.variance_m2;
    };
    const auto worst =
        std::max_element(inliers.begin(), inliers.end(),
                         [&](const PositionPair& a, const PositionPair& b) { return misfit(a) < misfit(b); });
    if (misfit(*worst) <= kGate) {
      if (found.xyz_yaw_covariance_P(3, 3) < kHeadingSigma_rad * kHeadingSigma_rad) position_frame_ = found;
      return;
    }
    inliers.erase(worst);
  }
}

}  // namespace tumble
