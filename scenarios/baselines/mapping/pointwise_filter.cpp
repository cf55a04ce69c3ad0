// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/pointwise_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/so3.hpp"
#include "tumble/mapping/detail/sweep_check.hpp"
#include "tumble/mapping/plane_fit.hpp"

namespace tumble::baselines {

namespace {

constexpr TimeNs kStep_ns = 50'000;  // points closer in time than this are processed together
constexpr double kGate = 81.0;       // accepts a point if gate * r^2 < range, the authors' rule
constexpr double kStartSigma_rad = 0.01, kStartSigma_m_s = 0.05, kStartSigma_rad_s = 0.1, kStartSigma_m_s2 = 0.5;

}  // namespace

PointwiseFilter::PointwiseFilter(const Params& params, const Eigen::Quaterniond& q_WI)
    : params_(params), q_WI_(q_WI), map_({params.map_voxel_m, params.map_spacing_m}) {
  require_fields(params);
  require_within("range_max_m", params.range_max_m, params.range_min_m, 1e4);
  f_m_s2_ = q_WI_.conjugate() * Eigen::Vector3d(0.0, 0.0, params.gravity_m_s2);
  P_.diagonal().segment<2>(3).setConstant(kStartSigma_rad * kStartSigma_rad);
  P_.diagonal().segment<3>(6).setConstant(kStartSigma_m_s * kStartSigma_m_s);
  P_.diagonal().segment<3>(9).setConstant(kStartSigma_rad_s * kStartSigma_rad_s);
  P_.diagonal().segment<3>(12).setConstant(kStartSigma_m_s2 * kStartSigma_m_s2);
}

Status PointwiseFilter::add_imu(const ImuSample& sample, unsigned clipped) {
  if (!is_finite(sample)) return {Trouble::non_finite, "imu sample", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (has_imu_ && sample.time_ns <= last_imu_ns_) {
    return {Trouble::time_order, "time_ns", double(sample.time_ns), double(last_imu_ns_)};
  }
  const TimeNs from_ns = has_imu_ ? last_imu_ns_ : sample.time_ns;
  readings_.push_back({(from_ns + sample.time_ns) / 2, sample.time_ns, sample.angular_velocity_rad_s,
                       sample.specific_force_m_s2, clipped});
  last_imu_ns_ = sample.time_ns;
  has_imu_ = true;
  return {};
}

/// Predicts the state at time `to_ns` in one step, with random walks of rate and force.
void PointwiseFilter::advance(TimeNs to_ns) {
  const double dt = seconds(to_ns - time_ns_);
  if (!(dt > 0.0)) return;
  time_ns_ = to_ns;
  const Eigen::Matrix3d R = q_WI_.toRotationMatrix();
  const Eigen::Vector3d force_W = R * f_m_s2_;
  const Eigen::Vector3d acceleration = force_W - Eigen::Vector3d(0.0, 0.0, params_.gravity_m_s2);
  p_m_ += dt * v_m_s_ + (0.5 * dt * dt) * acceleration;
  v_m_s_ += dt * acceleration;
  q_WI_ = (q_WI_ * so3::exp(w_rad_s_ * dt)).normalized();

  Matrix F = Matrix::Identity();
  F.block<3, 3>(0, 6) = dt * Eigen::Matrix3d::Identity();
  F.block<3, 3>(3, 9) = dt * R;
  F.block<3, 3>(6, 3) = -dt * so3::hat(force_W);
  F.block<3, 3>(6, 12) = dt * R;
  P_ = F * P_ * F.transpose();
  P_.diagonal().segment<3>(9).array() += dt * params_.rate_walk_rad_s_sqrt_s * params_.rate_walk_rad_s_sqrt_s;
  P_.diagonal().segment<3>(12).array() += dt * params_.force_walk_m_s2_sqrt_s * params_.force_walk_m_s2_sqrt_s;
}

/// Updates the state with one scalar measurement: residual = measured - expected. `row` is the derivative of the
/// measurement with respect to the error state.
void PointwiseFilter::update(const Vector& row, double residual, double variance) {
  if (!(row.dot(P_ * row) + variance > 0.0)) return;
  const Vector step = scalar_update(row, residual, variance, P_);
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  p_m_ += step.segment<3>(0);
  q_WI_ = (so3::exp(step.segment<3>(3)) * q_WI_).normalized();
  v_m_s_ += step.segment<3>(6);
  w_rad_s_ += step.segment<3>(9);
  f_m_s2_ += step.segment<3>(12);
}

void PointwiseFilter::take(const Reading& reading) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(reading.clipped >> axis & 1u)) {
      update(Vector::Unit(9 + axis), reading.rate_rad_s[axis] - w_rad_s_[axis],
             params_.gyro_sigma_rad_s * params_.gyro_sigma_rad_s);
    }
    if (!(reading.clipped >> (3 + axis) & 1u)) {
      update(Vector::Unit(12 + axis), reading.force_m_s2[axis] - f_m_s2_[axis],
             params_.accel_sigma_m_s2 * params_.accel_sigma_m_s2);
    }
  }
}

/// Implements the first two equations of (R16) and (R17) in mapping.md at a single instant.
bool PointwiseFilter::take(const SweepPoint& point) {
  const Eigen::Vector3d lever = q_WI_ * point.x_I_m.cast<double>();
  const Eigen::Vector3d position = p_m_ + lever;
  Neighbours found;
  map_.nearest(position.cast<float>(), params_.neighbours, static_cast<float>(params_.match_distance_m), found);
  PlaneBounds bounds;
  bounds.neighbours_min = std::min(bounds.neighbours_min, params_.neighbours);
  const PlaneFit plane = fit_plane(map_, found, bounds);
  if (plane.verdict != PlaneVerdict::plane) return false;
  const Eigen::Vector3d n = plane.normal_W.cast<double>();
  const double r = n.dot(position - plane.centre_W_m.cast<double>());
  if (kGate * r * r >= static_cast<double>(point.range_m)) return false;
  Vector row = Vector::Zero();
  row.segment<3>(0) = n;
  row.segment<3>(3) = lever.cross(n);
  update(row, -r, params_.plane_sigma_m * params_.plane_sigma_m);
  return true;
}

PoseState PointwiseFilter::pose() const {
  PoseState pose;
  pose.time_ns = time_ns_;
  pose.p_WA_m = p_m_;
  pose.q_WA = q_WI_;
  pose.v_WA_m_s = v_m_s_;
  pose.covariance = P_.topLeftCorner<6, 6>();
  return pose;
}

/// Processes points, IMU readings and output poses of the sweep in order of time.
void PointwiseFilter::take_points(TimeNs start_ns, TimeNs end_ns, LidarInertialOdometry::SweepReport& report) {
  std::vector<char> updates(points_.size(), 0);
  for (const std::uint32_t index : chosen_) updates[index] = 1;
  std::vector<std::uint32_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return points_[a].sweep_t_s < points_[b].sweep_t_s; });
  positions_m_.resize(points_.size());
  std::size_t next = 0, accepted = 0;
  const auto take_until = [&](TimeNs to_ns) {
    for (; next < order.size(); ++next) {
      const SweepPoint& point = points_[order[next]];
      const TimeNs at_ns = start_ns + static_cast<TimeNs>(std::llround(1e9 * static_cast<double>(point.sweep_t_s)));
      if (at_ns > to_ns) break;
      if (at_ns - time_ns_ >= kStep_ns) advance(at_ns);
      if (updates[order[next]] && map_.size() > 0) accepted += take(point);
      positions_m_[order[next]] = (p_m_ + q_WI_ * point.x_I_m.cast<double>()).cast<float>();
    }
  };
  // An IMU reading is applied at the middle of its averaging window. The pose of a reading is output at the end of the
  // reading's window, before the middle of the next window.
  const auto record_pose = [&](TimeNs at_ns) {
    if (at_ns <= start_ns || at_ns > end_ns) return;
    take_until(at_ns);
    advance(at_ns);
    report.trajectory.push_back(pose());
  };
  record_pose(window_end_ns_);
  while (!readings_.empty() && readings_.front().middle_ns <= end_ns) {
    const Reading reading = readings_.front();
    readings_.pop_front();
    take_until(reading.middle_ns);
    advance(reading.middle_ns);
    take(reading);
    window_end_ns_ = reading.end_ns;
    record_pose(window_end_ns_);
  }
  take_until(end_ns);
  advance(end_ns);
  report.inlier_share = chosen_.empty() ? 0.0 : static_cast<double>(accepted) / static_cast<double>(chosen_.size());
  report.iterations = static_cast<int>(accepted);
}

Status PointwiseFilter::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                                  LidarInertialOdometry::SweepReport& report) {
  report = LidarInertialOdometry::SweepReport{};
  if (end_ns < start_ns) return {Trouble::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (started_ && end_ns <= time_ns_) return {Trouble::time_order, "end_ns", double(end_ns), double(time_ns_)};
  if (!has_imu_ || last_imu_ns_ < end_ns) {
    return {Trouble::too_few, "imu time_ns", has_imu_ ? double(last_imu_ns_) : 0.0, double(end_ns)};
  }
  if (Status status = mapping::check_offsets(end_ns - start_ns, points); !status.ok()) return status;
  if (!started_) time_ns_ = start_ns;
  started_ = true;

  const PointBounds bounds{params_.range_min_m, params_.range_max_m, params_.own_body_L};
  const PointCounts counts = select_points(points, bounds, params_.T_IL, 0.0, points_);
  report.points_used = counts.used;
  const Status status = mapping::check_selection(end_ns - start_ns, points, counts);
  if (!status.ok()) points_.clear();
  positions_m_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) positions_m_[i] = points_[i].x_I_m;
  sampler_.choose(positions_m_, params_.sweep_voxel_m, chosen_);
  report.points_registered = chosen_.size();

  const bool first = map_.size() == 0;
  take_points(start_ns, end_ns, report);
  if (report.trajectory.empty() || report.trajectory.back().time_ns < end_ns) report.trajectory.push_back(pose());
  report.pose = pose();
  if (!status.ok()) return status;

  const auto accepted = static_cast<std::size_t>(report.iterations);
  if (first) {
    report.verdict = counts.used >= params_.updates_min ? SweepVerdict::first : SweepVerdict::rejected;
  } else if (chosen_.size() >= params_.updates_min) {
    report.verdict = accepted >= params_.updates_min ? SweepVerdict::registered : SweepVerdict::degenerate;
  }
  if (report.verdict == SweepVerdict::rejected) return status;
  const std::uint32_t base = scan_lines_.base(q_WI_ * params_.T_IL.linear().col(2), counts.rings_differ);
  const auto sweep = static_cast<std::uint32_t>(seen_from_W_m_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    report.map_points_added += map_.insert(positions_m_[i], static_cast<float>(params_.plane_sigma_m), sweep,
                                           mapping::ScanLines::line(base, points_[i].ring));
  }
  seen_from_W_m_.push_back(p_m_.cast<float>());
  return status;
}

std::vector<MapPoint> PointwiseFilter::map() const {
  return mapping::with_normals(map_, seen_from_W_m_, params_.neighbours, params_.match_distance_m);
}

}  // namespace tumble::baselines
