// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"

namespace tumble {

namespace {

constexpr double kPruneShare = 0.1;  // of the map's radius: moved so far, the sensor drops what is out of reach

/// What the trajectory is uncertain by inside of a stretch, as seen at a point: between its start and its end. Its part
/// of mapping.md (R53).
class PoseVariance {
 public:
  PoseVariance(const Registration::Matrix& covariance, const SweepTrajectory& trajectory)
      : duration_s_(std::max(trajectory.duration_s(), 1e-9)) {
    const SweepTrajectory::Transition step = trajectory.transition(trajectory.duration_s());
    constexpr int kMoving = Registration::kCalibration;
    Eigen::Matrix<double, 9, kMoving> F;
    F << step.by_start, step.by_excess_s;
    const Eigen::Matrix<double, 9, 9> end = F * covariance.topLeftCorner<kMoving, kMoving>() * F.transpose();
    start_m2_ = covariance.diagonal().head<3>().mean();
    start_rad2_ = covariance.diagonal().segment<3>(3).mean();
    end_m2_ = end.diagonal().head<3>().mean();
    end_rad2_ = end.diagonal().segment<3>(3).mean();
  }
  double at_m2(const SweepPoint& point) const {
    const double share = std::clamp(point.t_s / duration_s_, 0.0, 1.0);
    const double m2 = start_m2_ + share * (end_m2_ - start_m2_);
    const double rad2 = start_rad2_ + share * (end_rad2_ - start_rad2_);
    return std::max(m2 + rad2 * point.range_m * point.range_m, 0.0);
  }

 private:
  double duration_s_, start_m2_, start_rad2_, end_m2_, end_rad2_;
};

}  // namespace

std::size_t LidarInertialOdometry::Impl::extend_map(bool rings_differ) {
  if (covariance.diagonal().tail<SweepCalibration::kErrors>().maxCoeff() > 0.0) {
    const SweepCalibration& now = result.mean.calibration;
    apply_calibration(now, now.time_offset_s - calibration.time_offset_s, points);
  }
  compute_levers(trajectory, points, positions_W_m);
  const PoseVariance of_pose(result.covariance, trajectory);
  const std::uint32_t sweep = static_cast<std::uint32_t>(seen_from_W_m.size());
  const MotionState middle = trajectory.state(0.5 * trajectory.duration_s());
  const std::uint32_t line = scan_lines.base(middle.q_WI * params.T_IL.linear().col(2), rings_differ);
  std::size_t added = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f position = positions_W_m[i] + trajectory.base_m(points[i].t_s).cast<float>();
    // mapping.md (R53)
    const double sigma_m = std::sqrt(registration.point_variance_m2(points[i]) + of_pose.at_m2(points[i]));
    if (sigma_m > params.map_sigma_max_m) continue;
    const std::uint32_t index =
        map.add(position, static_cast<float>(sigma_m), sweep, mapping::ScanLines::line(line, points[i].ring));
    if (index == VoxelMap::kNoPoint) continue;
    ++added;
    if (params.window_sweeps > 1) drawn.push_back({index, points[i]});
  }
  seen_from_W_m.push_back(middle.p_WI_m.cast<float>());
  return added;
}

/// Keeps the local part of the map, and of the places that it was seen from.
void LidarInertialOdometry::Impl::forget_far_map() {
  const Eigen::Vector3f here = state.p_WI_m.cast<float>();
  const float moved = (here - pruned_at_W_m).norm();
  if (moved < static_cast<float>(kPruneShare * params.map_radius_m)) return;
  pruned_at_W_m = here;
  for (mapping::WindowSweep& sweep : window) sweep.drawn.clear();  // indices change
  const std::vector<std::uint32_t> kept = map.keep_within(here, static_cast<float>(params.map_radius_m));
  std::vector<Eigen::Vector3f> from(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) from[i] = seen_from_W_m[kept[i]];
  seen_from_W_m.swap(from);
}

std::vector<MapPoint> LidarInertialOdometry::map() const {
  return mapping::with_normals(impl_->map, impl_->seen_from_W_m, impl_->params.neighbours,
                               impl_->params.match_distance_m);
}

}  // namespace tumble
