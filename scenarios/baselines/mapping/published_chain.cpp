// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/published_chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"

namespace tumble::baselines {

namespace {

using Sweep = PublishedChain::Sweep;

struct SweepCell {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  double time_s = 0.0, skew_variance = 0.0;
  float count = 0.0f;
};

TimeNs rounded_offset(const LidarPoint& point, TimeNs step_ns) {
  return static_cast<TimeNs>(point.offset_ns) / step_ns * step_ns;
}

/// Returns the time at which the registration of a sweep estimates the pose, usually the start of the sweep. If all
/// points of a sweep have one time stamp, the result is this time stamp, because otherwise the velocity feedback of
/// PublishedChain would be unstable.
TimeNs registered_at(const Sweep& sweep, TimeNs step_ns) {
  if (sweep.points.empty()) return sweep.start_ns;
  const auto [first, last] = std::minmax_element(
      sweep.points.begin(), sweep.points.end(), [](const auto& a, const auto& b) { return a.offset_ns < b.offset_ns; });
  if (static_cast<TimeNs>(last->offset_ns) - static_cast<TimeNs>(first->offset_ns) >= step_ns) return sweep.start_ns;
  return sweep.start_ns + rounded_offset(*first, step_ns);
}

class SweepBounds {
 public:
  explicit SweepBounds(const PublishedChain::Params& params)
      : own_body_(params.own_body_L.cast<float>()),
        range_min_m_(static_cast<float>(params.range_min_m)),
        range_max_m_(params.range_max_m) {}

  bool hold(const Eigen::Vector3f& position_L_m) const {
    const float range_m = position_L_m.norm();
    return position_L_m.allFinite() && !(range_m > range_max_m_) && !own_body_.contains(position_L_m) &&
           !(range_m < range_min_m_);
  }

 private:
  Eigen::AlignedBox3f own_body_;
  float range_min_m_;
  double range_max_m_;
};

std::vector<TrimmedIcp::Point> means_of(std::span<const SweepCell> cells, double first_s,
                                        const PublishedChain::Params& params) {
  std::vector<TrimmedIcp::Point> points;
  points.reserve(cells.size());
  for (const SweepCell& cell : cells) {
    TrimmedIcp::Point& point = points.emplace_back();
    point.position_m = cell.sum / cell.count;
    const double count = static_cast<double>(cell.count);
    const double range =
        std::max(params.range_sigma_m, params.range_sigma_ratio * static_cast<double>(point.position_m.norm()));
    const double skew = params.skew_sigma_m_s * (cell.time_s / count - first_s);
    const double variance = params.voxel_averages_time ? skew * skew : cell.skew_variance / count;
    point.variance_m2 = static_cast<float>(range * range + variance);
  }
  return points;
}

std::vector<TrimmedIcp::Point> deskewed(const Sweep& sweep, TimeNs at_ns, const PublishedImuOdometry& odometry,
                                        const PublishedChain::Params& params) {
  const double rate = params.skew_sigma_m_s;
  const Eigen::Isometry3d from_odom = (odometry.pose(at_ns) * params.T_IL).inverse(Eigen::Isometry);
  const SweepBounds bounds(params);
  const auto voxel_m = static_cast<float>(params.sweep_voxel_m);
  std::unordered_map<std::uint64_t, std::size_t> index_of;
  std::vector<SweepCell> cells;
  TimeNs step = -1;
  Eigen::Isometry3f move = Eigen::Isometry3f::Identity();
  double first_s = std::numeric_limits<double>::infinity();
  for (const LidarPoint& point : sweep.points) {
    if (!bounds.hold(point.position_L_m)) continue;
    const TimeNs rounded = rounded_offset(point, params.stamp_step_ns);
    if (rounded != step) {
      step = rounded;
      move = (from_odom * odometry.pose(sweep.start_ns + rounded) * params.T_IL).cast<float>();
    }
    const Eigen::Vector3f x = move * point.position_L_m;
    const double t_s = seconds(static_cast<TimeNs>(point.offset_ns));
    first_s = std::min(first_s, t_s);
    const Eigen::Vector3i cube = (x / voxel_m).array().floor().cast<int>();
    const auto [it, added] = index_of.try_emplace(SpatialHash::key(cube), cells.size());
    if (added) cells.emplace_back();
    SweepCell& cell = cells[it->second];
    cell.sum += x;
    cell.time_s += t_s;
    cell.skew_variance += rate * rate * t_s * t_s;
    cell.count += 1.0f;
  }
  return means_of(cells, first_s, params);
}

PoseState pose_state(const Eigen::Isometry3d& T, const Eigen::Vector3d& v_m_s, TimeNs time_ns) {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.position_W_m = T.translation();
  pose.orientation_W = Eigen::Quaterniond(T.linear()).normalized();
  pose.velocity_W_m_s = v_m_s;
  return pose;
}

Status trouble_of(const Sweep& sweep, std::size_t in_range) {
  if (sweep.points.empty()) return {ErrorCode::empty, "points", 0.0, 1.0};
  const auto differs = [&](const LidarPoint& p) { return p.offset_ns != sweep.points.front().offset_ns; };
  if (std::none_of(sweep.points.begin(), sweep.points.end(), differs)) {
    return {ErrorCode::degenerate, "spread of offset_ns", 0.0, 1.0};
  }
  if (in_range == 0) return {ErrorCode::insufficient_data, "points in range", 0.0, 1.0};
  return {};
}

}  // namespace

PublishedChain::PublishedChain(const Params& params, std::span<const ImuSample> samples,
                               std::span<const AngularRateState> rates)
    : params_(params), samples_(samples), odometry_(params.madgwick_gain_rad_s, samples, rates), icp_(params.icp) {
  require_valid_fields(params);
}

bool PublishedChain::covers(const Sweep& sweep) const {
  return samples_.back().time_ns >= sweep.end_ns && samples_.front().time_ns <= sweep.end_ns;
}

Status PublishedChain::add(const Sweep& sweep, SweepResult& report) {
  for (const LidarPoint& point : sweep.points) {
    if (point.offset_ns <= sweep.end_ns - sweep.start_ns) continue;
    return {ErrorCode::out_of_range, "offset_ns", double(point.offset_ns), double(sweep.end_ns - sweep.start_ns)};
  }
  odometry_.advance(sweep.end_ns);
  const TimeNs at_ns = registered_at(sweep, params_.stamp_step_ns);
  std::vector<TrimmedIcp::Point> points = deskewed(sweep, at_ns, odometry_, params_);
  const Status error_code = trouble_of(sweep, points.size());
  if (!error_code.ok()) points.clear();
  const bool registered = registers(sweep, at_ns, points, report);
  report_poses(sweep, report);
  if (registered) feed_back(at_ns);
  return error_code;
}

std::vector<MapPoint> PublishedChain::map() const {
  return mapping::to_map_points(map_, seen_from_, 20, 1.0);
}

bool PublishedChain::registers(const Sweep& sweep, TimeNs at_ns, std::span<const TrimmedIcp::Point> points,
                               SweepResult& report) {
  report.usable_points = sweep.points.size();
  report.points_after_downsampling = points.size();
  if (dead_ || points.empty()) return false;
  const Eigen::Isometry3d in_odom = odometry_.pose(at_ns) * params_.T_IL;
  Eigen::Isometry3d T = T_map_odom_ * in_odom;
  if (map_.size() == 0) {
    report.verdict = SweepVerdict::first;
  } else {
    const TrimmedIcp::Result result = icp_.align(points, T, map_);
    report.iterations = result.iterations;
    report.inlier_ratio = result.kept_share;
    dead_ = result.verdict != RegistrationVerdict::converged && params_.abort_ends_mapping;
    if (result.verdict != RegistrationVerdict::converged) return false;
    report.verdict = SweepVerdict::registered;
    T = result.T;
  }
  T_map_odom_ = T * in_odom.inverse(Eigen::Isometry);
  extend(points, T, report);
  return true;
}

void PublishedChain::extend(std::span<const TrimmedIcp::Point> points, const Eigen::Isometry3d& T_WL,
                            SweepResult& report) {
  const Eigen::Isometry3f move = T_WL.cast<float>();
  const auto spacing_m = static_cast<float>(params_.map_spacing_m);
  std::vector<std::uint32_t> fresh;
  NearestNeighbours found;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    map_.nearest(move * points[i].position_m, 1, spacing_m, found);
    if (found.count == 0) fresh.push_back(i);
  }
  for (const std::uint32_t i : fresh) {
    report.map_points_added += map_.insert(move * points[i].position_m, std::sqrt(points[i].variance_m2),
                                           static_cast<std::uint32_t>(seen_from_.size()));
  }
  seen_from_.push_back(move.translation());
  icp_.forget_normals();
}

void PublishedChain::report_poses(const Sweep& sweep, SweepResult& report) {
  const auto at = [&](TimeNs time_ns) {
    return pose_state(T_map_odom_ * odometry_.pose(time_ns), T_map_odom_.linear() * odometry_.velocity_m_s(time_ns),
                      time_ns);
  };
  for (const ImuSample& sample : samples_) {
    if (sample.time_ns > sweep.start_ns && sample.time_ns <= sweep.end_ns)
      report.trajectory.push_back(at(sample.time_ns));
  }
  report.pose = at(sweep.end_ns);
  if (report.trajectory.empty()) report.trajectory.push_back(report.pose);
}

void PublishedChain::feed_back(TimeNs at_ns) {
  const Eigen::Vector3d here_m = (T_map_odom_ * odometry_.pose(at_ns)).translation();
  if (registered_ns_ && at_ns > *registered_ns_) {
    const Eigen::Vector3d mean = (here_m - registered_m_) / seconds(at_ns - *registered_ns_);
    odometry_.feed_back(T_map_odom_.linear().transpose() * mean,
                        params_.late_velocity ? at_ns : (at_ns + *registered_ns_) / 2);
  }
  registered_ns_ = at_ns;
  registered_m_ = here_m;
}

}  // namespace tumble::baselines
