// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/rigid_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/mapping/detail/deskew.hpp"

namespace tumble::baselines {

namespace {

using SweepResult = LidarInertialOdometry::SweepResult;

Eigen::Isometry3d pose_of(const MotionState& state) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = state.q_WI.toRotationMatrix();
  T.translation() = state.p_WI_m;
  return T;
}

}  // namespace

RigidOdometry::RigidOdometry(const Params& params)
    : params_(params), map_({params.map_voxel_m, params.map_spacing_m}), registration_(params.registration) {}

Status RigidOdometry::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                                const Motion& motion, SweepResult& report) {
  report = SweepResult{};
  if (end_ns < start_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (motion.start.time_ns > start_ns) {
    return {ErrorCode::time_order, "motion.start", double(motion.start.time_ns), double(start_ns)};
  }
  if (Status status = mapping::check_time_offsets(end_ns - start_ns, points); !status.ok()) return status;
  SweepTrajectory trajectory;
  if (Status status = trajectory.build(motion.start, motion.samples, end_ns, motion.gravity_m_s2); !status.ok()) {
    return status;
  }
  predicted_ = trajectory.state(trajectory.duration_s());
  predicted_.time_ns = end_ns;
  predicted_.covariance = motion.end_covariance;
  state_ = predicted_;

  const PointSelectionBounds bounds{params_.range_min_m, params_.range_max_m, params_.own_body_L};
  const PointCounts counts =
      select_points(points, bounds, params_.T_IL, seconds(start_ns - motion.start.time_ns), points_);
  report.usable_points = counts.usable_points;
  const Status status = mapping::check_point_selection(end_ns - start_ns, points, counts);
  if (status.ok()) {
    deskew(trajectory, points_, trajectory.duration_s(), positions_m_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i].x_I_m = positions_m_[i];
      points_[i].t_s = 0.0f;
    }
    const bool first = map_.size() == 0;
    if (first && counts.usable_points >= params_.registration.expert.matches_min) report.verdict = SweepVerdict::first;
    if (!first) register_points(report);
    extend_map(counts.has_ring_numbers, report);
  }
  describe(trajectory, report);
  return status;
}

void RigidOdometry::place(const Eigen::Isometry3d& T_WI) {
  const Eigen::Isometry3f T = T_WI.cast<float>();
  positions_m_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) positions_m_[i] = T * points_[i].x_I_m;
}

void RigidOdometry::register_points(SweepResult& report) {
  place(pose_of(predicted_));
  sampler_.choose_points_per_voxel(positions_m_, params_.sweep_voxel_m, chosen_index_);
  chosen_.clear();
  for (const std::uint32_t index : chosen_index_) chosen_.push_back(points_[index]);
  report.points_after_downsampling = chosen_.size();

  // The points are already deskewed to the end of the sweep, so the registration gets one constant pose as trajectory.
  MotionSample instant;
  instant.from_ns = predicted_.time_ns - 1;
  instant.time_ns = predicted_.time_ns;
  const Registration::Prior prior(predicted_);
  SweepTrajectory still;
  Registration::Result result;
  const Status status = registration_.align(prior, {&instant, 1}, predicted_.time_ns, chosen_, map_, still, result);
  report.iterations = result.iterations;
  report.inlier_ratio = result.points == 0 ? 0.0 : double(result.inliers) / double(result.points);
  if (!status.ok()) return;
  if (result.verdict == RegistrationVerdict::too_few_matches &&
      chosen_.size() >= params_.registration.expert.matches_min) {
    report.verdict = SweepVerdict::degenerate;  // no constraints: keep the motion model
  }
  if (result.verdict != RegistrationVerdict::converged) return;
  state_ = result.mean.state;
  report.eigenvalue_ratio = result.eigenvalues[5] > 0.0 ? result.eigenvalues[0] / result.eigenvalues[5] : 0.0;
  report.least_constrained_pose_direction_W = result.directions.col(0);
  report.least_constrained_sigma_m = result.least_constrained_sigma_m;
  report.verdict = report.least_constrained_sigma_m > params_.degenerate_sigma_m ? SweepVerdict::degenerate
                                                                                 : SweepVerdict::registered;
}

void RigidOdometry::extend_map(bool has_ring_numbers, SweepResult& report) {
  const Eigen::Isometry3d T_WI = pose_of(state_);
  place(T_WI);
  const std::uint32_t base =
      scan_lines_.line_number_offset((T_WI.linear() * params_.T_IL.linear()).col(2), has_ring_numbers);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto sigma = static_cast<float>(std::sqrt(registration_.point_variance_m2(points_[i])));
    report.map_points_added +=
        map_.insert(positions_m_[i], sigma, sweeps_, mapping::ScanLines::line(base, points_[i].ring));
  }
  ++sweeps_;
}

void RigidOdometry::describe(const SweepTrajectory& trajectory, SweepResult& report) const {
  const Eigen::Isometry3d correction = pose_of(state_) * pose_of(predicted_).inverse(Eigen::Isometry);
  const Eigen::Quaterniond turned(correction.linear());
  const Eigen::Vector3d faster = state_.v_WI_m_s - turned * predicted_.v_WI_m_s;
  for (std::size_t i = 0; i < trajectory.intervals(); ++i) {
    PoseState pose = trajectory.state(trajectory.interval_end_s(i)).pose();
    pose.position_W_m = correction * pose.position_W_m;
    pose.orientation_W = (turned * pose.orientation_W).normalized();
    pose.velocity_W_m_s = turned * pose.velocity_W_m_s + faster;
    pose.covariance = state_.covariance.topLeftCorner<6, 6>();
    report.trajectory.push_back(pose);
  }
  report.trajectory.back().time_ns = state_.time_ns;
  report.pose = state_.pose();
}

}  // namespace tumble::baselines
