// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/deskew.hpp"

#include <cmath>

#include "tumble/common/types.hpp"

namespace tumble {

PointCounts select_points(std::span<const LidarPoint> points, const PointSelectionBounds& bounds,
                          const Eigen::Isometry3d& T_IL, double sweep_start_s, std::vector<SweepPoint>& selected) {
  selected.clear();
  PointCounts counts;
  counts.received = points.size();
  const Eigen::Matrix3f R = T_IL.linear().cast<float>();
  const Eigen::Vector3f p = T_IL.translation().cast<float>();
  const float near2 = static_cast<float>(bounds.range_min_m * bounds.range_min_m);
  const float far2 = static_cast<float>(bounds.range_max_m * bounds.range_max_m);
  const Eigen::AlignedBox3f body(bounds.own_body_L.min().cast<float>(), bounds.own_body_L.max().cast<float>());
  const bool has_body = !bounds.own_body_L.isEmpty();
  for (const LidarPoint& point : points) {
    if (!point.position_L_m.allFinite()) continue;
    ++counts.finite;
    const float range2 = point.position_L_m.squaredNorm();
    if (range2 < near2 || range2 > far2 || (has_body && body.contains(point.position_L_m))) continue;
    const double offset_s = seconds(point.offset_ns);
    selected.push_back({R * point.position_L_m + p, point.position_L_m, static_cast<float>(sweep_start_s + offset_s),
                        static_cast<float>(offset_s), std::sqrt(range2), point.ring});
    counts.has_ring_numbers |= point.ring != selected.front().ring;
  }
  counts.usable_points = selected.size();
  return counts;
}

void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved) {
  moved.assign(points.begin(), points.end());
  apply_calibration(calibration, later_s, moved);
}

void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<SweepPoint> points) {
  const Eigen::Matrix3f R = calibration.T_IL.linear().cast<float>();
  const Eigen::Vector3f p = calibration.T_IL.translation().cast<float>();
  for (SweepPoint& point : points) {
    point.x_I_m = R * point.point_L_m + p;
    point.t_s += static_cast<float>(later_s);
  }
}

/// See mapping.md (R3).
void compute_lever_arm_vectors(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                               std::vector<Eigen::Vector3f>& levers_W_m) {
  levers_W_m.resize(points.size());
  trajectory.lever_arm_vectors(points, levers_W_m);
}

/// See mapping.md (R12).
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m) {
  compute_lever_arm_vectors(trajectory, points, positions_I_m);
  std::size_t hint = trajectory.intervals();
  const SweepTrajectory::PreintegratedMotion target = trajectory.at(target_s, hint);
  const Eigen::Vector3d origin = trajectory.gravity_free_position_m(target_s) + target.preintegrated_position_m;
  const Eigen::Quaterniond q_IW = target.q_WI.conjugate();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d world = trajectory.gravity_free_position_m(points[i].t_s) + positions_I_m[i].cast<double>();
    positions_I_m[i] = (q_IW * (world - origin)).cast<float>();
  }
}

void SweepSampler::choose_points_per_voxel(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m,
                                           std::vector<std::uint32_t>& chosen) {
  occupied_voxels_.clear();
  chosen.clear();
  const float cubes_per_m = static_cast<float>(1.0 / voxel_m);
  for (std::uint32_t i = 0; i < positions_W_m.size(); ++i) {
    const Eigen::Vector3f scaled = positions_W_m[i] * cubes_per_m;
    if (!(scaled.cwiseAbs().maxCoeff() < static_cast<float>(SpatialHash::kCoordinateLimit - 2))) continue;
    if (occupied_voxels_.add(SpatialHash::key(scaled.array().floor().cast<int>()))) chosen.push_back(i);
  }
}

}  // namespace tumble
